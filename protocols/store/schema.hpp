/// \file The tables, and how older databases become newer ones.
/// Format: docs/data-dictionary.md, "Database".
#pragma once

#include "protocols/store/database.hpp"
#include "protocols/store/tables.hpp"

#include <filesystem>
#include <span>

namespace touchtrial::store {

/// One step forward; runs inside a transaction.
using Migration = void (*)(SQLite::Database&);

/// migrations()[v] makes version v + 1 of version v; version 0 is an empty database.
[[nodiscard]] std::span<const Migration> migrations();

/// Brings a database to version `steps.size()` in one transaction. Unless it is empty, a copy of it
/// is laid at backup_path first.
/// \throws StoreError if a step fails, which leaves the database as it was, or
///   another copy exists
void migrate(const Database& database, std::span<const Migration> steps);

[[nodiscard]] int schema_version(const Database& database);

/// A copy of the whole database, whatever else is written meanwhile, under a name that is free.
/// \throws StoreError if another program keeps it from being read
void write_copy(const Database& database, const std::filesystem::path& to);

/// `<db>.v<version>.backup`
[[nodiscard]] std::filesystem::path backup_path(const std::filesystem::path& database, int version);

}  // namespace touchtrial::store
