/// \file The tables on a server: those of an SQLite file (protocols/collect/server_tables.hpp) and a few
/// that only a server needs. Private to protocols/collect.
#pragma once

#include "protocols/collect/server_connection.hpp"
#include "protocols/collect/server_tables.hpp"

#include <optional>
#include <span>
#include <string>

namespace touchtrial::collect {

inline constexpr TypeNames kServerTypes = {"BIGINT", "DOUBLE PRECISION", "TEXT", "BYTEA"};

/// One step forward. It runs inside a transaction.
using ServerMigration = void (*)(ServerWork&);

/// server_migrations()[i] makes version kOldestSchemaVersion + i + 1 of the one before it.
[[nodiscard]] std::span<const ServerMigration> server_migrations();

/// The version of the tables, or nothing if the database has none of ours.
/// \throws StoreError if another program's tables have their names, or no schema exists to look in
[[nodiscard]] std::optional<int> server_version(ServerConnection& server);

/// Makes the tables of kSchemaVersion, or brings existing ones to the newest version, which follows
/// from `steps`, in one transaction. If two programs do it at once, one waits for the other.
/// \throws StoreError if the tables are newer, too old or not ours; they are then left alone
void bring_forward(ServerConnection& server,
                   std::span<const ServerMigration> steps = server_migrations());

/// \throws StoreError, with the remedy, unless the tables are there and of this version
void require_current(ServerConnection& server);

}  // namespace touchtrial::collect
