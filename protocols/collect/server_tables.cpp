#include "protocols/collect/server_tables.hpp"

#include "core/text.hpp"
#include "protocols/store/damage.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace touchtrial::collect {
namespace {

using enum ColumnType;
using Names = std::string_view;

constexpr auto kEvents = std::to_array<TableColumn>({{"session", integer},
                                                     {"sequence", integer},
                                                     {"kind", text},
                                                     {"at_ns", integer},
                                                     {"body", text},
                                                     {"sealed", blob},
                                                     {"previous", blob},
                                                     {"hash", blob},
                                                     {"signature", blob},
                                                     {"own_session", integer, true}});
constexpr auto kTraces = std::to_array<TableColumn>(
    {{"session", integer}, {"trial", integer}, {"box", blob, false, {}, true}});
constexpr auto kKeys = std::to_array<TableColumn>({{"session", integer}, {"wrapped", blob}});
constexpr auto kStationKeys = std::to_array<TableColumn>({{"session", integer}, {"kept", blob}});
constexpr auto kSessions = std::to_array<TableColumn>({{"session", integer},
                                                       {"participant", text},
                                                       {"enrolment", integer},
                                                       {"state", text},
                                                       {"simulated", integer},
                                                       {"pilot", integer},
                                                       {"excluded", integer},
                                                       {"withdrawn", integer},
                                                       {"erased", integer},
                                                       {"device", text},
                                                       {"replaced_by", text, true},
                                                       {"own_session", integer, true},
                                                       {"station", integer, false, "0"},
                                                       {"visit", integer, false, "1"}});
constexpr auto kTrials = std::to_array<TableColumn>({{"session", integer},
                                                     {"trial", integer},
                                                     {"block", integer},
                                                     {"state", text},
                                                     {"valid", integer},
                                                     {"contact_ok", integer},
                                                     {"path_ok", integer},
                                                     {"force_ok", integer},
                                                     {"speed_ok", integer},
                                                     {"overruns", integer},
                                                     {"rate_hz", real},
                                                     {"explorations", integer}});

constexpr auto kOfEvent = std::to_array<Names>({"session", "sequence"});
constexpr auto kOfSession = std::to_array<Names>({"session"});
constexpr auto kOfTrial = std::to_array<Names>({"session", "trial"});

constexpr auto kTakenOnce = std::to_array<UniqueIndex>(
    {{"sessions_participant", "participant, visit", "replaced_by IS NULL"},
     {"sessions_enrolment", "enrolment, visit", "replaced_by IS NULL"}});

constexpr auto kTrialsRefer = std::to_array<TableReference>({{"session", "sessions"}});

constexpr auto kTables = std::to_array<TableDefinition>({
    {"events", kEvents, kOfEvent, true},
    {"traces", kTraces, kOfTrial, true},
    {"participant_keys", kKeys, kOfSession},
    {"safety_keys", kKeys, kOfSession},
    {"station_keys", kStationKeys, kOfSession, false, {}, {}, true},
    {"sessions", kSessions, kOfSession, false, kTakenOnce},
    {"trials", kTrials, kOfTrial, false, {}, kTrialsRefer},
});

std::string reference_sql(const TableReference& reference) {
  return "REFERENCES " + std::string(reference.table) + "(" + std::string(reference.column) + ")";
}

std::string column_sql(const TableDefinition& table, const TableColumn& column,
                       const TypeNames& types) {
  std::string sql =
      std::string(column.name) + " " + std::string(types.at(static_cast<std::size_t>(column.type)));
  if (table.key.size() == 1 && table.key.front() == column.name) return sql + " PRIMARY KEY";
  if (!column.nullable) sql += " NOT NULL";
  if (!column.default_value.empty()) sql += " DEFAULT " + std::string(column.default_value);
  for (const TableReference& reference : table.references) {
    if (reference.column == column.name) sql += " " + reference_sql(reference);
  }
  return sql;
}

template <typename State, std::size_t N>
Cell state_cell(const std::array<std::string_view, N>& names, State state) {
  return std::string(names.at(static_cast<std::size_t>(state)));
}

Cell cell_of(bool flag) {
  return std::int64_t{flag};
}

/// Takes the values of a row from left to right, and refuses those that no event can give rise to.
class CellReader {
 public:
  CellReader(std::span<const Cell> cells, const char* table) : cells_(cells), table_(table) {}

  [[nodiscard]] int whole() { return whole_of(integer()); }
  [[nodiscard]] std::optional<int> optional_whole() {
    if (skip_null()) return std::nullopt;
    return whole();
  }
  [[nodiscard]] std::int64_t integer() { return next<std::int64_t>(); }
  [[nodiscard]] double real() { return next<double>(); }
  [[nodiscard]] std::string text() { return next<std::string>(); }
  [[nodiscard]] std::string text_or_empty() { return skip_null() ? std::string() : text(); }
  [[nodiscard]] bool flag() {
    const std::int64_t number = integer();
    if (number != 0 && number != 1) refuse();
    return number == 1;
  }
  template <typename State, std::size_t N>
  [[nodiscard]] State state(const std::array<std::string_view, N>& names) {
    const auto* const found = std::find(names.begin(), names.end(), text());
    if (found == names.end()) refuse();
    return static_cast<State>(found - names.begin());
  }

 private:
  template <typename Value>
  [[nodiscard]] Value next() {
    const Value* const value = std::get_if<Value>(&cells_[at_++]);
    if (value == nullptr) refuse();
    return *value;
  }
  [[nodiscard]] bool skip_null() {
    const bool is_null = std::holds_alternative<std::monostate>(cells_[at_]);
    at_ += is_null ? 1 : 0;
    return is_null;
  }
  [[nodiscard]] int whole_of(std::int64_t number) const {
    if (number < 0 || number > std::numeric_limits<int>::max()) refuse();
    return static_cast<int>(number);
  }
  [[noreturn]] void refuse() const {
    const auto* const session = std::get_if<std::int64_t>(&cells_.front());
    throw store::EventFault(
        session == nullptr ? 0 : *session, store::kNoEvent,
        std::string("derived table ") + table_ + " holds a value that no event gives rise to");
  }

  std::span<const Cell> cells_;
  const char* table_;
  std::size_t at_ = 0;
};

}  // namespace

std::span<const TableDefinition> table_definitions() {
  return kTables;
}

const TableDefinition& table_definition(Table table) {
  return kTables.at(static_cast<std::size_t>(table));
}

std::string column_list(Table table, std::string_view prefix) {
  return listed(table_definition(table).columns, ", ", [&](const TableColumn& column) {
    return std::string(prefix) + std::string(column.name);
  });
}

std::string create_table_sql(const TableDefinition& table, const TypeNames& types) {
  std::string sql = "CREATE TABLE " + std::string(table.name) + "(\n";
  for (const TableColumn& column : table.columns) {
    sql += "  " + column_sql(table, column, types) + ",\n";
  }
  if (table.key.size() > 1) sql += "  PRIMARY KEY(" + listed(table.key) + "),\n";
  return sql.substr(0, sql.size() - 2) + "\n)";
}

std::string create_indices_sql(const TableDefinition& table) {
  std::string sql;
  for (const UniqueIndex& index : table.unique) {
    sql += "CREATE UNIQUE INDEX " + std::string(index.name) + " ON " + std::string(table.name) +
           "(" + std::string(index.columns) + ") WHERE " + std::string(index.where) + ";\n";
  }
  return sql;
}

std::string add_visits_sql(std::string_view integer) {
  return "ALTER TABLE sessions ADD COLUMN visit " + std::string(integer) +
         " NOT NULL DEFAULT 1;\nDROP INDEX sessions_participant;\nDROP INDEX "
         "sessions_enrolment;\n" +
         create_indices_sql(table_definition(Table::sessions));
}

Cells session_cells(const store::SessionRow& row, OwnNumber own) {
  const bool says_own = own == OwnNumber::always || row.own_session != row.session;
  return {std::int64_t{row.session},
          row.participant,
          std::int64_t{row.enrolment},
          state_cell(store::kSessionStates, row.state),
          cell_of(row.simulated),
          cell_of(row.pilot),
          cell_of(row.excluded),
          cell_of(row.withdrawn),
          cell_of(row.erased),
          row.device,
          row.replaced_by.empty() ? Cell() : Cell(row.replaced_by),
          says_own ? Cell(std::int64_t{row.own_session}) : Cell(),
          std::int64_t{row.station},
          std::int64_t{row.visit}};
}

Cells trial_cells(const store::TrialRow& row) {
  return {std::int64_t{row.session},
          std::int64_t{row.trial},
          std::int64_t{row.block},
          state_cell(store::kTrialStates, row.state),
          cell_of(row.valid),
          cell_of(row.hand.contact),
          cell_of(row.hand.path),
          cell_of(row.hand.force),
          cell_of(row.hand.speed),
          row.overruns,
          row.rate_hz,
          std::int64_t{row.explorations}};
}

Cells cells_of(Table table, const std::function<Cell(int, ColumnType)>& cell) {
  Cells cells;
  cells.reserve(table_definition(table).columns.size());
  for (const TableColumn& column : table_definition(table).columns) {
    cells.push_back(cell(static_cast<int>(cells.size()), column.type));
  }
  return cells;
}

store::SessionRow session_row(std::span<const Cell> cells) {
  CellReader row(cells, "sessions");
  const int session = row.whole();
  // Members are initialised in the order of the columns.
  return {.session = session,
          .participant = row.text(),
          .enrolment = row.whole(),
          .state = row.state<store::SessionState>(store::kSessionStates),
          .simulated = row.flag(),
          .pilot = row.flag(),
          .excluded = row.flag(),
          .withdrawn = row.flag(),
          .erased = row.flag(),
          .device = row.text(),
          .replaced_by = row.text_or_empty(),
          .own_session = row.optional_whole().value_or(session),
          .station = row.whole(),
          .visit = row.whole()};
}

store::TrialRow trial_row(std::span<const Cell> cells) {
  CellReader trial(cells, "trials");
  store::TrialRow row;
  row.session = trial.whole();
  row.trial = trial.whole();
  row.block = trial.whole();
  row.state = trial.state<store::TrialState>(store::kTrialStates);
  row.valid = trial.flag();
  row.hand.contact = trial.flag();
  row.hand.path = trial.flag();
  row.hand.force = trial.flag();
  row.hand.speed = trial.flag();
  row.overruns = trial.integer();
  row.rate_hz = trial.real();
  row.explorations = trial.whole();
  return row;
}

}  // namespace touchtrial::collect
