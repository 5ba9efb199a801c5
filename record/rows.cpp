#include "record/rows.hpp"

#include <limits>
#include <string>
#include <utility>

namespace touchtrial::record {
namespace {

constexpr std::int64_t kLowest = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kHighest = std::numeric_limits<std::int64_t>::max();

constexpr const char* kEventsSql =
    "SELECT session, sequence, kind, at_ns, body, sealed, previous, hash, signature, own_session "
    "FROM events ";

/// \throws EventFault if the number is impossible for a session
std::optional<int> renumbered_from(const Query& row, int column) {
  if (row.is_null(column)) return std::nullopt;
  const std::int64_t number = row.integer(column);
  if (number < 0 || number > std::numeric_limits<int>::max()) {
    throw EventFault(row.integer(0), row.integer(1),
                     "its session number at the station is impossible");
  }
  return static_cast<int>(number);
}

/// \throws EventFault if the number is impossible for a chain
int session_number(std::int64_t session, std::int64_t sequence) {
  if (session < std::numeric_limits<int>::min() || session > std::numeric_limits<int>::max()) {
    throw EventFault(session, sequence, "its session number is impossible");
  }
  return static_cast<int>(session);
}

/// \param row  all columns of events
Event event_of_row(const Query& row) {
  const std::int64_t session = row.integer(0);
  const std::int64_t sequence = row.integer(1);
  const EventKind kind = stored_kind(row.text(2), session, sequence);
  return {.session = session_number(session, sequence),
          .sequence = sequence,
          .kind = kind,
          .at = std::chrono::nanoseconds(row.integer(3)),
          .body = row.text(4),
          .sealed = row.blob(5),
          .previous = stored_hash(row.blob_view(6), session, sequence),
          .hash = stored_hash(row.blob_view(7), session, sequence),
          .signature = row.blob(8),
          .renumbered_from = renumbered_from(row, 9)};
}

/// The condition on kinds, for instance " AND kind IN ('opened','closed')"; empty for all kinds.
std::string kind_filter_sql(std::span<const EventKind> kinds) {
  if (kinds.empty()) return {};
  std::string names;
  for (const EventKind kind : kinds) {
    names += (names.empty() ? "'" : ",'") + std::string(name_of(kind)) + "'";
  }
  return " AND kind IN (" + names + ")";
}

}  // namespace

void insert_event(const Database& database, const Event& event) {
  database
      .query(
          "INSERT INTO events(session, sequence, kind, at_ns, body, sealed, previous, hash, "
          "signature, own_session) VALUES(?,?,?,?,?,?,?,?,?,?)")
      .bind(event.session)
      .bind(event.sequence)
      .bind(name_of(event.kind))
      .bind(event.at.count())
      .bind(event.body)
      .bind(event.sealed)
      .bind(event.previous)
      .bind(event.hash)
      .bind(event.signature)
      .bind(event.renumbered_from)
      .run();
}

void insert_trace(const Database& database, const SealedTrace& trace) {
  database.query("INSERT INTO traces(session, trial, box) VALUES(?,?,?)")
      .bind(trace.session)
      .bind(trace.trial)
      .bind(trace.box)
      .run();
}

void insert_keys(const Database& database, int session, const WrappedKeys& keys) {
  const auto insert = [&](const char* sql, const std::optional<Bytes>& wrapped) {
    if (wrapped) database.query(sql).bind(session).bind(*wrapped).run();
  };
  insert("INSERT INTO participant_keys(session, wrapped) VALUES(?,?)", keys.participant);
  insert("INSERT INTO safety_keys(session, wrapped) VALUES(?,?)", keys.safety);
}

WrappedKeys read_keys(const Database& database, int session) {
  const auto read = [&](const char* sql) -> std::optional<Bytes> {
    Query query = database.query(sql);
    query.bind(session);
    if (!query.step()) return std::nullopt;
    return query.blob(0);
  };
  return {.participant = read("SELECT wrapped FROM participant_keys WHERE session = ?"),
          .safety = read("SELECT wrapped FROM safety_keys WHERE session = ?")};
}

void insert_station_key(const Database& database, int session, const Bytes& stored_key) {
  database.query("INSERT INTO station_keys(session, kept) VALUES(?,?)")
      .bind(session)
      .bind(stored_key)
      .run();
}

void for_each_event(const Database& database, const EventFilter& filter,
                    const EventVisitor& visit) {
  const std::string sql = kEventsSql +
                          ("WHERE session BETWEEN ? AND ?" + kind_filter_sql(filter.kinds)) +
                          " ORDER BY session, sequence";
  Query query = database.separate_query(sql.c_str());
  query.bind(filter.session.value_or(kLowest)).bind(filter.session.value_or(kHighest));
  while (query.step()) visit(event_of_row(query));
}

void for_each_event(const Database& database, std::int64_t session, const EventVisitor& visit) {
  for_each_event(database, {.session = session}, visit);
}

std::vector<Event> read_events(const Database& database, int session, std::exception_ptr& fault) {
  static const std::string sql = std::string(kEventsSql) + "WHERE session = ? ORDER BY sequence";
  std::vector<Event> events;
  try {
    Query query = database.query(sql.c_str());
    query.bind(session);
    while (query.step()) events.push_back(event_of_row(query));
  } catch (...) {
    fault = std::current_exception();
  }
  return events;
}

std::optional<Event> read_event(const Database& database, int session, std::int64_t sequence) {
  // Reads by primary key, because the range query of for_each_event would scan all events of the
  // session.
  static const std::string sql = std::string(kEventsSql) + "WHERE session = ? AND sequence = ?";
  Query query = database.query(sql.c_str());
  query.bind(session).bind(sequence);
  if (!query.step()) return std::nullopt;
  return event_of_row(query);
}

std::vector<std::int64_t> sessions_with_events(const Database& database) {
  // Jumps from session to session, because DISTINCT would read every event.
  std::vector<std::int64_t> sessions;
  const auto add_from = [&](std::int64_t lowest) {
    Query query = database.query("SELECT min(session) FROM events WHERE session >= ?");
    query.bind(lowest);
    if (!query.step() || query.is_null(0)) return false;
    sessions.push_back(query.integer(0));
    return sessions.back() < kHighest;
  };
  for (bool has_more = add_from(kLowest); has_more;) has_more = add_from(sessions.back() + 1);
  std::erase(sessions, 0);
  return sessions;
}

std::optional<Event> read_last_event(const Database& database, int session) {
  Query query = database.query("SELECT max(sequence) FROM events WHERE session = ?");
  query.bind(session);
  if (!query.step() || query.is_null(0)) return std::nullopt;
  return read_event(database, session, query.integer(0));
}

std::map<int, SessionRow> read_sessions(const Database& database) {
  DerivedRows rows;
  for (const std::int64_t number : sessions_with_events(database)) {
    if (number < 0) continue;
    const int session = session_number(number, 0);
    // Events between opening and end change only trials.
    if (const auto first = read_event(database, session, 0)) fold(rows, *first);
    const auto last = read_last_event(database, session);
    if (last && last->kind == EventKind::closed) fold(rows, *last);
  }
  for_each_event(database, 0, [&](const Event& event) { fold(rows, event); });
  return std::move(rows.sessions);
}

std::vector<TrialRow> read_trials(const Database& database) {
  // The query omits hashes and sealed parts, which are most of a row.
  Query query = database.query(
      "SELECT session, sequence, kind, body FROM events WHERE session > 0 AND kind IN ('opened', "
      "'presented', 'answered', 'interrupted', 'timed-out', 'trace-stored', 'explored-again', "
      "'block-restarted') ORDER BY session, sequence");
  DerivedRows rows;
  while (query.step()) {
    Event event;
    event.sequence = query.integer(1);
    event.session = session_number(query.integer(0), event.sequence);
    event.kind = stored_kind(query.text(2), event.session, event.sequence);
    event.body = query.text(3);
    event.sealed = Bytes(1);
    fold(rows, event);
  }
  std::vector<TrialRow> trials;
  trials.reserve(rows.trials.size());
  for (const auto& [id, row] : rows.trials) trials.push_back(row);
  return trials;
}

}  // namespace touchtrial::record
