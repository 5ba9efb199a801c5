/// \file The tables in an SQLite file: how they are made, brought forward and checked. Private to
/// protocols/store. Format: docs/data-dictionary.md, "Database".
#pragma once

#include "protocols/store/database.hpp"
#include "protocols/store/tables.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace touchtrial::store {

/// One step forward. It runs inside a transaction.
using Migration = void (*)(SQLite::Database&);

/// migrations()[i] makes version kOldestSchemaVersion + i + 1 of the one before it.
[[nodiscard]] std::span<const Migration> migrations();

/// Makes the tables of kSchemaVersion in an empty database, in one transaction.
void make_tables(const Database& database);

/// Opens an existing database whose tables are of the newest version, which follows from `steps`.
/// Older tables are first brought forward, in one transaction, if the database is opened for
/// writing.
/// \throws StoreError as Database::open; also if a step fails, which leaves the database as it was,
///   and if the tables are older and the database is opened for reading
[[nodiscard]] Database open_current(const std::filesystem::path& path, Database::Mode mode,
                                    std::span<const Migration> steps = migrations());

[[nodiscard]] int schema_version(const Database& database);

/// Compares the tables, indices and triggers of a database with those of kSchemaVersion. Finds, for
/// instance, a dropped trigger, an altered table, or a view that stands in for a table.
/// \return the first difference, by type and name; nothing if there is none
[[nodiscard]] std::optional<std::string> schema_fault(const Database& database);

}  // namespace touchtrial::store
