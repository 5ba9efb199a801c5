#include "protocols/store/tables.hpp"

#include <array>

namespace touchtrial::store {
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
                                                     {"own_session", integer, true}});
constexpr auto kTraces = std::to_array<TableColumn>(
    {{"session", integer}, {"trial", integer}, {"box", blob, false, {}, true}});
constexpr auto kKeys = std::to_array<TableColumn>({{"session", integer}, {"wrapped", blob}});
constexpr auto kSessions = std::to_array<TableColumn>({{"session", integer},
                                                       {"participant", text},
                                                       {"enrolment", integer},
                                                       {"state", text},
                                                       {"simulated", integer},
                                                       {"pilot", integer},
                                                       {"excluded", integer},
                                                       {"withdrawn", integer},
                                                       {"device", text},
                                                       {"replaced_by", text, true},
                                                       {"own_session", integer, true},
                                                       {"station", integer, false, "0"}});
constexpr auto kTrials = std::to_array<TableColumn>({{"session", integer},
                                                     {"trial", integer},
                                                     {"block", integer},
                                                     {"state", text},
                                                     {"presented_at_ns", integer},
                                                     {"contact_at_ns", integer, true},
                                                     {"valid", integer},
                                                     {"overruns", integer},
                                                     {"samples", integer},
                                                     {"rate_hz", real},
                                                     {"explorations", integer}});
constexpr auto kResponses = std::to_array<TableColumn>({{"session", integer},
                                                        {"trial", integer},
                                                        {"answered_at_ns", integer},
                                                        {"position", integer},
                                                        {"first_position", integer, true},
                                                        {"confidence", integer, true}});

constexpr auto kOfEvent = std::to_array<Names>({"session", "sequence"});
constexpr auto kOfSession = std::to_array<Names>({"session"});
constexpr auto kOfTrial = std::to_array<Names>({"session", "trial"});

constexpr auto kTakenOnce =
    std::to_array<UniqueIndex>({{"sessions_participant", "participant", "replaced_by IS NULL"},
                                {"sessions_enrolment", "enrolment", "replaced_by IS NULL"}});

constexpr auto kTrialsRefer = std::to_array<TableReference>({{kOfSession, "sessions"}});
constexpr auto kResponsesRefer = std::to_array<TableReference>({{kOfTrial, "trials"}});

constexpr auto kTables = std::to_array<TableDefinition>({
    {"events", kEvents, kOfEvent, true},
    {"traces", kTraces, kOfTrial, true},
    {"participant_keys", kKeys, kOfSession},
    {"sessions", kSessions, kOfSession, false, kTakenOnce},
    {"trials", kTrials, kOfTrial, false, {}, kTrialsRefer},
    {"responses", kResponses, kOfTrial, false, {}, kResponsesRefer},
});

std::string listed(std::span<const Names> names) {
  std::string text;
  for (const Names name : names) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

std::string reference_sql(const TableReference& reference) {
  return "REFERENCES " + std::string(reference.table) + "(" + listed(reference.columns) + ")";
}

std::string column_sql(const TableDefinition& table, const TableColumn& column,
                       const TypeNames& types) {
  std::string sql =
      std::string(column.name) + " " + std::string(types.at(static_cast<std::size_t>(column.type)));
  if (table.key.size() == 1 && table.key.front() == column.name) return sql + " PRIMARY KEY";
  if (!column.nullable) sql += " NOT NULL";
  if (!column.default_value.empty()) sql += " DEFAULT " + std::string(column.default_value);
  for (const TableReference& reference : table.references) {
    if (reference.columns.size() == 1 && reference.columns.front() == column.name) {
      sql += " " + reference_sql(reference);
    }
  }
  return sql;
}

}  // namespace

std::span<const TableDefinition> table_definitions() {
  return kTables;
}

const TableDefinition& table_definition(Table table) {
  return kTables.at(static_cast<std::size_t>(table));
}

std::string column_list(const TableDefinition& table, std::string_view prefix) {
  std::string text;
  for (const TableColumn& column : table.columns) {
    text += (text.empty() ? "" : ", ") + std::string(prefix) + std::string(column.name);
  }
  return text;
}

std::string create_table_sql(const TableDefinition& table, const TypeNames& types) {
  std::string sql = "CREATE TABLE " + std::string(table.name) + "(\n";
  for (const TableColumn& column : table.columns) {
    sql += "  " + column_sql(table, column, types) + ",\n";
  }
  if (table.key.size() > 1) sql += "  PRIMARY KEY(" + listed(table.key) + "),\n";
  for (const TableReference& reference : table.references) {
    if (reference.columns.size() == 1) continue;  // stands with its column
    sql += "  FOREIGN KEY(" + listed(reference.columns) + ") " + reference_sql(reference) + ",\n";
  }
  return sql.substr(0, sql.size() - 2) + "\n)";
}

std::string create_indices_sql(const TableDefinition& table) {
  std::string sql;
  for (const UniqueIndex& index : table.unique) {
    sql += "CREATE UNIQUE INDEX " + std::string(index.name) + " ON " + std::string(table.name) +
           "(" + std::string(index.column) + ") WHERE " + std::string(index.where) + ";\n";
  }
  return sql;
}

}  // namespace touchtrial::store
