/// \file The tables of a study as data. SQLite's and a server's tables, the check of a file's
/// schema, and the statements on derived tables are all made from it. What each column means:
/// docs/data-dictionary.md, "Database".
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

namespace touchtrial::store {

/// Counts every change of the tables, in files and on servers.
inline constexpr int kSchemaVersion = 3;
/// The oldest version that can be brought forward; those before it were never released.
inline constexpr int kOldestSchemaVersion = 3;

/// integer: 64 bits, signed. real: 64 bits. text: UTF-8. blob: bytes.
enum class ColumnType { integer, real, text, blob };

struct TableColumn {
  std::string_view name;
  ColumnType type{};
  bool nullable = false;
  /// SQL, the same in all dialects, for rows that do not name the column; empty: they must.
  std::string_view default_value{};
  /// Large and sealed: bytes that do not shrink, and that are kept apart from the table's key.
  bool bulky = false;
};

/// Columns of which no two rows have the same values.
struct UniqueIndex {
  std::string_view name;
  std::string_view column;
  std::string_view where;  ///< SQL condition that rows must meet to be held to it
};

/// Columns that name a row of another table.
struct TableReference {
  std::span<const std::string_view> columns;
  std::string_view table;  ///< whose columns of the same names are its key
};

struct TableDefinition {
  std::string_view name;
  std::span<const TableColumn> columns;
  std::span<const std::string_view> key;  ///< columns that name a row, in the order of the key
  bool append_only = false;               ///< rows are neither changed nor removed
  std::span<const UniqueIndex> unique{};
  std::span<const TableReference> references{};
};

/// In this order each table comes after those that it refers to.
enum class Table { events, traces, participant_keys, sessions, trials, responses };

[[nodiscard]] std::span<const TableDefinition> table_definitions();
[[nodiscard]] const TableDefinition& table_definition(Table table);

/// "session, trial, box". \param prefix  put before every name, for instance "t."
[[nodiscard]] std::string column_list(const TableDefinition& table, std::string_view prefix = {});

/// What a dialect of SQL calls the types, in the order of ColumnType.
using TypeNames = std::array<std::string_view, 4>;

/// "CREATE TABLE trials(...)", to which a dialect adds what it has of its own.
[[nodiscard]] std::string create_table_sql(const TableDefinition& table, const TypeNames& types);
/// One statement for each of the table's unique indices.
[[nodiscard]] std::string create_indices_sql(const TableDefinition& table);

}  // namespace touchtrial::store
