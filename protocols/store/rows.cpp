#include "protocols/store/rows.hpp"

#include "protocols/store/event_fault.hpp"
#include "protocols/store/row_cells.hpp"
#include "protocols/store/tables.hpp"

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

namespace touchtrial::store {
namespace {

constexpr std::int64_t kLowest = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kHighest = std::numeric_limits<std::int64_t>::max();

std::string columns_of(Table table, std::string_view prefix = {}) {
  return column_list(table_definition(table), prefix);
}

/// "INSERT INTO trials(...) VALUES(?,...)"
std::string insertion(Table table) {
  const TableDefinition& definition = table_definition(table);
  std::string places = "?";
  for (std::size_t i = 1; i < definition.columns.size(); ++i) places += ",?";
  return "INSERT INTO " + std::string(definition.name) + "(" + columns_of(table) + ") VALUES(" +
         places + ")";
}

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

/// \param row  all columns of events
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

/// Insertion of a row, or its change to the new values.
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

Cell cell_of(const Query& row, int column, ColumnType type) {
  if (row.is_null(column)) return {};
  switch (type) {
    case ColumnType::integer:
      return row.integer(column);
    case ColumnType::real:
      return row.real(column);
    case ColumnType::text:
      return row.text(column);
    case ColumnType::blob:
      break;  // derived tables have none
  }
  return {};
}

/// \param tables  whose columns the row has, one table after the other
Cells cells_of(const Query& row, std::initializer_list<Table> tables) {
  Cells cells;
  cells.reserve(20);
  for (const Table table : tables) {
    for (const TableColumn& column : table_definition(table).columns) {
      cells.push_back(cell_of(row, static_cast<int>(cells.size()), column.type));
    }
  }
  return cells;
}

void visit_sessions(const Database& database, std::int64_t first, std::int64_t last,
                    const std::function<void(const SessionRow&)>& visit) {
  static const std::string sql = "SELECT " + columns_of(Table::sessions) +
                                 " FROM sessions WHERE session BETWEEN ? AND ? ORDER BY session";
  Query query = database.query(sql.c_str());
  query.bind(first).bind(last);
  while (query.step()) visit(session_row(cells_of(query, {Table::sessions})));
}

/// From the first trial id to the last, in both members.
void visit_trials(const Database& database, std::pair<std::int64_t, std::int64_t> first,
                  std::pair<std::int64_t, std::int64_t> last,
                  const std::function<void(const TrialRow&)>& visit) {
  static const std::string sql =
      "SELECT " + columns_of(Table::trials, "t.") + ", " + columns_of(Table::responses, "r.") +
      " FROM trials t LEFT JOIN responses r USING(session, trial) WHERE t.session BETWEEN ? AND ? "
      "AND t.trial BETWEEN ? AND ? ORDER BY t.session, t.trial";
  Query query = database.query(sql.c_str());
  query.bind(first.first).bind(last.first).bind(first.second).bind(last.second);
  while (query.step()) visit(trial_row(cells_of(query, {Table::trials, Table::responses})));
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
  // An answer is final, so that a response is only ever added.
  static const std::string addition = insertion(Table::responses) + " ON CONFLICT DO NOTHING";
  if (row.position) write(database, addition, response_cells(row));
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
      .bind(event.renumbered_from)
      .run();
}

void insert_trace(const Database& database, const SealedTrace& trace) {
  static const std::string sql = insertion(Table::traces);
  database.query(sql.c_str()).bind(trace.session).bind(trace.trial).bind(trace.box).run();
}

void for_each_event(const Database& database, const EventFilter& filter,
                    const EventVisitor& visit) {
  std::optional<std::string_view> kind;
  if (filter.kind) kind = name_of(*filter.kind);
  std::optional<std::string> any_of;
  if (!filter.kinds.empty()) any_of = bars_around(filter.kinds);
  static const std::string sql = "SELECT " + columns_of(Table::events) +
                                 " FROM events WHERE session BETWEEN ? AND ? AND sequence BETWEEN "
                                 "? AND ? AND kind = coalesce(?, kind) "
                                 "AND (?6 IS NULL OR instr(?6, '|' || kind || '|') > 0) "
                                 "ORDER BY session, sequence";
  Query query = database.separate_query(sql.c_str());
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

void delete_all_rows(const Database& database) {
  database.connection().exec("DELETE FROM responses; DELETE FROM trials; DELETE FROM sessions;");
}

}  // namespace touchtrial::store
