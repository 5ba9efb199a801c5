#include "protocols/store/event_rows.hpp"

#include "protocols/store/event_fault.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <string_view>

namespace touchtrial::store {
namespace {

constexpr std::int64_t kLowest = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kHighest = std::numeric_limits<std::int64_t>::max();

Digest digest_of(const Query& row, int column) {
  const Bytes bytes = row.blob(column);
  Digest digest{};
  if (bytes.size() != digest.size()) {
    throw EventFault(row.integer(0), row.integer(1), "a hash of the event is not 32 bytes long");
  }
  std::copy(bytes.begin(), bytes.end(), digest.begin());
  return digest;
}

/// \throws EventFault if the number is none that a session can have had in its station's file
std::optional<int> renumbered_from(const Query& row, int column) {
  if (row.is_null(column)) return std::nullopt;
  const std::int64_t number = row.integer(column);
  if (number < 0 || number > std::numeric_limits<int>::max()) {
    throw EventFault(row.integer(0), row.integer(1), "no session of a station has this number");
  }
  return static_cast<int>(number);
}

/// \param row  session, sequence, kind, at_ns, body, sealed, previous, hash, own_session
Event event_of_row(const Query& row) {
  const std::int64_t session = row.integer(0);
  const std::int64_t sequence = row.integer(1);
  const std::string name = row.text(2);
  const std::optional<EventKind> kind = event_kind_from_name(name);
  if (!kind) throw EventFault(session, sequence, "unknown kind of event '" + name + "'");
  if (session < std::numeric_limits<int>::min() || session > std::numeric_limits<int>::max()) {
    throw EventFault(session, sequence, "no session has this number");
  }
  return {.session = static_cast<int>(session),
          .sequence = sequence,
          .kind = *kind,
          .at = std::chrono::nanoseconds(row.integer(3)),
          .body = row.text(4),
          .sealed = row.blob(5),
          .previous = digest_of(row, 6),
          .hash = digest_of(row, 7),
          .renumbered_from = renumbered_from(row, 8)};
}

/// "|opened|closed|", which the database searches for a kind between bars.
std::string bars_around(std::span<const EventKind> kinds) {
  std::string names;
  for (const EventKind kind : kinds) names += '|' + std::string(name_of(kind));
  return names + '|';
}

}  // namespace

void insert_event(const Database& database, const Event& event) {
  database
      .query(
          "INSERT INTO events(session, sequence, kind, at_ns, body, sealed, previous, hash, "
          "own_session) VALUES(?,?,?,?,?,?,?,?,?)")
      .bind(event.session)
      .bind(event.sequence)
      .bind(name_of(event.kind))
      .bind(event.at.count())
      .bind(event.body)
      .bind(event.sealed)
      .bind(event.previous)
      .bind(event.hash)
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

void for_each_event(const Database& database, const EventFilter& filter,
                    const EventVisitor& visit) {
  std::optional<std::string_view> kind;
  if (filter.kind) kind = name_of(*filter.kind);
  std::optional<std::string> any_of;
  if (!filter.kinds.empty()) any_of = bars_around(filter.kinds);
  Query query = database.separate_query(
      "SELECT session, sequence, kind, at_ns, body, sealed, previous, hash, own_session FROM "
      "events "
      "WHERE session BETWEEN ? AND ? AND sequence BETWEEN ? AND ? AND kind = coalesce(?, kind) "
      "AND (?6 IS NULL OR instr(?6, '|' || kind || '|') > 0) "
      "ORDER BY session, sequence");
  query.bind(filter.session.value_or(kLowest)).bind(filter.session.value_or(kHighest));
  query.bind(filter.sequence.value_or(kLowest)).bind(filter.sequence.value_or(kHighest));
  query.bind(kind).bind(any_of);
  while (query.step()) visit(event_of_row(query));
}

void for_each_event(const Database& database, std::int64_t session, const EventVisitor& visit) {
  for_each_event(database, {.session = session, .sequence = {}, .kind = {}}, visit);
}

std::optional<Event> read_event(const Database& database, int session, std::int64_t sequence) {
  std::optional<Event> found;
  for_each_event(database, {.session = session, .sequence = sequence, .kind = {}},
                 [&](const Event& event) { found = event; });
  return found;
}

std::vector<std::int64_t> sessions_with_events(const Database& database) {
  Query query = database.query("SELECT DISTINCT session FROM events WHERE session <> 0 ORDER BY 1");
  std::vector<std::int64_t> sessions;
  while (query.step()) sessions.push_back(query.integer(0));
  return sessions;
}

}  // namespace touchtrial::store
