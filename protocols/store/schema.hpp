/// \file The tables in an SQLite file: how they are made, brought forward and checked.
/// Private to protocols/store. Format: docs/data-dictionary.md, "Database".
#pragma once

#include "protocols/store/database.hpp"
#include "protocols/store/tables.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace touchtrial::store {

/// One step forward; runs inside a transaction.
using Migration = void (*)(SQLite::Database&);

/// migrations()[i] makes version kOldestSchemaVersion + i + 1 of the one before it.
[[nodiscard]] std::span<const Migration> migrations();

/// Makes the tables of kSchemaVersion in an empty database, in one transaction.
void make_tables(const Database& database);

/// Opens an existing database whose tables are of the newest version, which follows from `steps`.
/// For writing, older ones are first brought forward, in one transaction.
/// \throws StoreError as Database::open; if a step fails, which leaves the database as it was; for
///   reading, if the tables are older
[[nodiscard]] Database open_current(const std::filesystem::path& path, Database::Mode mode,
                                    std::span<const Migration> steps = migrations());

[[nodiscard]] int schema_version(const Database& database);

/// Whether a database has the tables, indices and triggers of kSchemaVersion, and no others: a
/// dropped trigger, an altered table, a view that stands in for something.
/// \return what differs, by type and name; nothing if all agrees
[[nodiscard]] std::optional<std::string> schema_fault(const Database& database);

}  // namespace touchtrial::store
