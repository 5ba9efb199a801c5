#include "protocols/store/rows.hpp"

#include "protocols/store/tables.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

namespace touchtrial::store {
namespace {

constexpr std::int64_t kLowest = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kHighest = std::numeric_limits<std::int64_t>::max();

/// "INSERT INTO trials(...) VALUES(?,...)"
std::string insertion(Table table) {
  const TableDefinition& definition = table_definition(table);
  std::string places = "?";
  for (std::size_t i = 1; i < definition.columns.size(); ++i) places += ",?";
  return "INSERT INTO " + std::string(definition.name) + "(" + column_list(table) + ") VALUES(" +
         places + ")";
}

/// \throws EventFault if no session of a station can have the number
std::optional<int> renumbered_from(const Query& row, int column) {
  if (row.is_null(column)) return std::nullopt;
  const std::int64_t number = row.integer(column);
  if (number < 0 || number > std::numeric_limits<int>::max()) {
    throw EventFault(row.integer(0), row.integer(1), "no session of a station has this number");
  }
  return static_cast<int>(number);
}

/// \param row  all columns of events
Event event_of_row(const Query& row) {
  const std::int64_t session = row.integer(0);
  const std::int64_t sequence = row.integer(1);
  const EventKind kind = stored_kind(row.text(2), session, sequence);
  if (session < std::numeric_limits<int>::min() || session > std::numeric_limits<int>::max()) {
    throw EventFault(session, sequence, "no session has this number");
  }
  return {.session = static_cast<int>(session),
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

/// " AND kind IN ('opened','closed')"; empty: any kind will do.
std::string is_one_of(std::span<const EventKind> kinds) {
  if (kinds.empty()) return {};
  std::string names;
  for (const EventKind kind : kinds) {
    names += (names.empty() ? "'" : ",'") + std::string(name_of(kind)) + "'";
  }
  return " AND kind IN (" + names + ")";
}

/// Inserts a row, or changes the row with the same key to the new values.
std::string insertion_or_change(Table table) {
  const TableDefinition& definition = table_definition(table);
  std::string key;
  std::string changes;
  for (const TableColumn& column : definition.columns) {
    const std::string name(column.name);
    const bool in_key = std::ranges::find(definition.key, column.name) != definition.key.end();
    std::string& text = in_key ? key : changes;
    text += (text.empty() ? "" : ", ") + (in_key ? name : name + " = excluded." + name);
  }
  return insertion(table) + " ON CONFLICT(" + key + ") DO UPDATE SET " + changes;
}

/// \param table  whose columns the row has
Cells row_cells(const Query& row, Table table) {
  return cells_of(table, [&](int column, ColumnType type) -> Cell {
    if (row.is_null(column)) return {};
    if (type == ColumnType::integer) return row.integer(column);
    if (type == ColumnType::real) return row.real(column);
    return row.text(column);  // derived tables have no blobs
  });
}

void visit_sessions(const Database& database, std::int64_t first, std::int64_t last,
                    const std::function<void(const SessionRow&)>& visit) {
  static const std::string sql = "SELECT " + column_list(Table::sessions) +
                                 " FROM sessions WHERE session BETWEEN ? AND ? ORDER BY session";
  Query query = database.query(sql.c_str());
  query.bind(first).bind(last);
  while (query.step()) visit(session_row(row_cells(query, Table::sessions)));
}

/// From the first trial id to the last, in both members.
void visit_trials(const Database& database, std::pair<std::int64_t, std::int64_t> first,
                  std::pair<std::int64_t, std::int64_t> last,
                  const std::function<void(const TrialRow&)>& visit) {
  static const std::string sql =
      "SELECT " + column_list(Table::trials) +
      " FROM trials WHERE session BETWEEN ? AND ? AND trial BETWEEN ? AND ? "
      "ORDER BY session, trial";
  Query query = database.query(sql.c_str());
  query.bind(first.first).bind(last.first).bind(first.second).bind(last.second);
  while (query.step()) visit(trial_row(row_cells(query, Table::trials)));
}

void write(const Database& database, const std::string& sql, const Cells& cells) {
  Query query = database.query(sql.c_str());
  for (const Cell& cell : cells) query.bind(cell);
  query.run();
}

void write_session(const Database& database, const SessionRow& row) {
  static const std::string sql = insertion_or_change(Table::sessions);
  write(database, sql, session_cells(row));
}

void write_trial(const Database& database, const TrialRow& row) {
  static const std::string sql = insertion_or_change(Table::trials);
  write(database, sql, trial_cells(row));
}

}  // namespace

void insert_event(const Database& database, const Event& event) {
  static const std::string sql = insertion(Table::events);
  database.query(sql.c_str())
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
  static const std::string sql = insertion(Table::traces);
  database.query(sql.c_str()).bind(trace.session).bind(trace.trial).bind(trace.box).run();
}

void insert_keys(const Database& database, int session, const WrappedKeys& keys) {
  static const std::string participant = insertion(Table::participant_keys);
  static const std::string safety = insertion(Table::safety_keys);
  if (keys.participant) {
    database.query(participant.c_str()).bind(session).bind(*keys.participant).run();
  }
  if (keys.safety) database.query(safety.c_str()).bind(session).bind(*keys.safety).run();
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

void insert_station_key(const Database& database, int session, const Bytes& kept) {
  static const std::string sql = insertion(Table::station_keys);
  database.query(sql.c_str()).bind(session).bind(kept).run();
}

void for_each_event(const Database& database, const EventFilter& filter,
                    const EventVisitor& visit) {
  const std::string sql = "SELECT " + column_list(Table::events) +
                          " FROM events WHERE session BETWEEN ? AND ?" + is_one_of(filter.kinds) +
                          " ORDER BY session, sequence";
  Query query = database.separate_query(sql.c_str());
  query.bind(filter.session.value_or(kLowest)).bind(filter.session.value_or(kHighest));
  while (query.step()) visit(event_of_row(query));
}

void for_each_event(const Database& database, std::int64_t session, const EventVisitor& visit) {
  for_each_event(database, {.session = session}, visit);
}

std::vector<Event> read_events(const Database& database, int session, std::exception_ptr& fault) {
  static const std::string sql =
      "SELECT " + column_list(Table::events) + " FROM events WHERE session = ? ORDER BY sequence";
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
  // By its whole key: the ranges of for_each_event would walk through all events of the session.
  static const std::string sql =
      "SELECT " + column_list(Table::events) + " FROM events WHERE session = ? AND sequence = ?";
  Query query = database.query(sql.c_str());
  query.bind(session).bind(sequence);
  if (!query.step()) return std::nullopt;
  return event_of_row(query);
}

std::vector<std::int64_t> sessions_with_events(const Database& database) {
  // From one session's first event to the next one's: DISTINCT would read every event.
  std::vector<std::int64_t> sessions;
  const auto add_from = [&](std::int64_t lowest) {
    Query query = database.query("SELECT min(session) FROM events WHERE session >= ?");
    query.bind(lowest);
    if (!query.step() || query.is_null(0)) return false;
    sessions.push_back(query.integer(0));
    return sessions.back() < kHighest;
  };
  for (bool more = add_from(kLowest); more;) more = add_from(sessions.back() + 1);
  std::erase(sessions, 0);
  return sessions;
}

std::vector<SessionRow> read_sessions(const Database& database) {
  std::vector<SessionRow> rows;
  visit_sessions(database, kLowest, kHighest, [&](const SessionRow& row) { rows.push_back(row); });
  return rows;
}

std::vector<TrialRow> read_trials(const Database& database) {
  std::vector<TrialRow> rows;
  visit_trials(database, {kLowest, kLowest}, {kHighest, kHighest},
               [&](const TrialRow& row) { rows.push_back(row); });
  return rows;
}

DerivedRows read_rows(const Database& database, const FoldScope& scope) {
  DerivedRows rows;
  if (scope.session) {
    visit_sessions(database, *scope.session, *scope.session,
                   [&](const SessionRow& row) { rows.sessions[row.session] = row; });
  }
  if (scope.block) {
    const int session = scope.block->first;
    visit_trials(database, {session, kLowest}, {session, kHighest}, [&](const TrialRow& row) {
      if (row.block == scope.block->second) rows.trials[{row.session, row.trial}] = row;
    });
  }
  if (scope.trial) {
    visit_trials(database, *scope.trial, *scope.trial, [&](const TrialRow& row) {
      rows.trials[{row.session, row.trial}] = row;
    });
  }
  return rows;
}

void write_rows(const Database& database, const DerivedRows& rows) {
  for (const auto& [session, row] : rows.sessions) write_session(database, row);
  for (const auto& [id, row] : rows.trials) write_trial(database, row);
}

}  // namespace touchtrial::store
