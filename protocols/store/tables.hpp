/// \file The tables of the newest schema as data, from which every database that keeps them is
/// rendered: SQLite's are held to this by a test, a server's are made from it. What each column
/// means: docs/data-dictionary.md, "Database".
#pragma once

#include <span>
#include <string_view>

namespace touchtrial::store {

/// Counts every change of the tables, in files and on servers.
inline constexpr int kSchemaVersion = 3;

/// integer: 64 bits, signed. real: 64 bits. text: UTF-8. blob: bytes.
enum class ColumnType { integer, real, text, blob };

struct TableColumn {
  std::string_view name;
  ColumnType type{};
  bool nullable = false;
  /// SQL, the same in all dialects, for rows that do not name the column; empty: they must.
  std::string_view default_value{};
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

/// events, traces, participant_keys, sessions, trials, responses: each after those that it refers
/// to.
[[nodiscard]] std::span<const TableDefinition> table_definitions();

}  // namespace touchtrial::store
