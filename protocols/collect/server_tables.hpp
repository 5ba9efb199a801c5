/// \file The tables of a study on a server as data, and rows of derived tables as values of their
/// columns. What each column means: docs/data-dictionary.md, "Database".
#pragma once

#include "protocols/store/fold.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace touchtrial::collect {

/// Counts every change of the tables, in files and on servers.
inline constexpr int kSchemaVersion = 6;
/// The oldest version that can be brought forward; earlier ones were never released.
inline constexpr int kOldestSchemaVersion = 5;

/// integer: 64 bits, signed. real: 64 bits. text: UTF-8. blob: bytes.
enum class ColumnType { integer, real, text, blob };

struct TableColumn {
  std::string_view name;
  ColumnType type{};
  bool nullable = false;
  /// SQL, the same in all dialects, for rows that do not name the column; empty: they must name it.
  std::string_view default_value{};
  /// Large and encrypted: the bytes do not compress, and are stored apart from the table's key.
  bool bulky = false;
};

/// No two of the rows that meet the condition have the same values in the columns.
struct UniqueIndex {
  std::string_view name;
  std::string_view columns;  ///< SQL list
  std::string_view where;    ///< SQL condition
};

/// A column that names a row of another table.
struct TableReference {
  std::string_view column;
  std::string_view table;  ///< its column of the same name is its key
};

struct TableDefinition {
  std::string_view name;
  std::span<const TableColumn> columns;
  std::span<const std::string_view> key;  ///< columns that name a row, in the order of the key
  bool append_only = false;               ///< rows are neither changed nor removed
  std::span<const UniqueIndex> unique{};
  std::span<const TableReference> references{};
  bool at_stations_alone = false;  ///< servers do not have it
};

/// Each table comes after those that it refers to.
enum class Table { events, traces, participant_keys, safety_keys, station_keys, sessions, trials };

[[nodiscard]] std::span<const TableDefinition> table_definitions();
[[nodiscard]] const TableDefinition& table_definition(Table table);

/// "session, trial, box".
/// \param prefix  put before every name, for instance "t."
[[nodiscard]] std::string column_list(Table table, std::string_view prefix = {});

/// What a dialect of SQL calls the types, in the order of ColumnType.
using TypeNames = std::array<std::string_view, 4>;

/// Version 6: sessions have visits. The statements of all dialects that bring version 5 forward.
/// \param integer  what the dialect calls that type
[[nodiscard]] std::string add_visits_sql(std::string_view integer);

/// "CREATE TABLE trials(...)", to which each dialect adds its own clauses.
[[nodiscard]] std::string create_table_sql(const TableDefinition& table, const TypeNames& types);
/// One statement for each of the table's unique indices.
[[nodiscard]] std::string create_indices_sql(const TableDefinition& table);

/// A value of one column; std::monostate stands for NULL.
using Cell = std::variant<std::monostate, std::int64_t, double, std::string>;
/// The values of a row of a derived table, in the order of its columns.
using Cells = std::vector<Cell>;

/// When a row of sessions has a value in own_session.
enum class OwnNumber { if_other, always };

[[nodiscard]] Cells session_cells(const store::SessionRow& row,
                                  OwnNumber own = OwnNumber::if_other);
[[nodiscard]] Cells trial_cells(const store::TrialRow& row);

/// Reads the columns of one row of a derived table.
/// \param cell  gives the value of a column by its place in the row, from 0, and its type
[[nodiscard]] Cells cells_of(Table table, const std::function<Cell(int, ColumnType)>& cell);

/// \throws EventFault if a cell holds a value that no event can give rise to
[[nodiscard]] store::SessionRow session_row(std::span<const Cell> cells);
/// \throws the same
[[nodiscard]] store::TrialRow trial_row(std::span<const Cell> cells);

}  // namespace touchtrial::collect
