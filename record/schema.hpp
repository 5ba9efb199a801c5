/// \file Creates and checks the tables of an SQLite file. Private to record. Columns:
/// docs/data-dictionary.md, "Database".
#pragma once

#include "record/database.hpp"

#include <array>
#include <optional>
#include <string>

namespace touchtrial::record {

inline constexpr std::array kTables = {"events", "traces", "participant_keys", "safety_keys",
                                       "station_keys"};

/// Creates the tables of kSchemaVersion in an empty database, in one transaction.
void make_tables(const Database& database);

struct SchemaFault {
  std::string what;    ///< the first difference, by type and name
  std::string remedy;  ///< a shell command that removes all additions; empty: none
};

/// Compares the tables, indices and triggers of a database with those of kSchemaVersion. Finds, for
/// instance, a dropped trigger, an altered table, or a view in place of a table. SQLite's internal
/// tables, such as those of ANALYZE, are allowed.
[[nodiscard]] std::optional<SchemaFault> schema_fault(const Database& database);

}  // namespace touchtrial::record
