/// \file The tables on a server: those of an SQLite file (protocols/store/tables.hpp) and what a
/// server needs beside them. Private to protocols/collect.
#pragma once

#include "protocols/collect/server_connection.hpp"
#include "protocols/store/tables.hpp"

#include <optional>
#include <span>
#include <string>

namespace touchtrial::collect {

inline constexpr store::TypeNames kServerTypes = {"BIGINT", "DOUBLE PRECISION", "TEXT", "BYTEA"};

/// One step forward; runs inside a transaction.
using ServerMigration = void (*)(pqxx::work&);

/// server_migrations()[i] makes version kOldestSchemaVersion + i + 1 of the one before it.
[[nodiscard]] std::span<const ServerMigration> server_migrations();

/// Nothing if the database has no tables of ours.
/// \throws StoreError if there are others under their names, or no schema to look in
[[nodiscard]] std::optional<int> server_version(ServerConnection& server);

/// Makes the tables of kSchemaVersion, or brings those that are there to the newest version, which
/// follows from `steps`, in one transaction; two programs that do it at once come one after the
/// other.
/// \throws StoreError if the tables are newer or too old, which are left alone, or not ours
void bring_forward(ServerConnection& server,
                   std::span<const ServerMigration> steps = server_migrations());

/// \throws StoreError, with the remedy, unless the tables are there and of this version
void require_current(ServerConnection& server);

}  // namespace touchtrial::collect
