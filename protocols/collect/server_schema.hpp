/// \file The tables on a server: those of an SQLite file (protocols/store/tables.hpp) and what a
/// server needs beside them. Private to protocols/collect.
#pragma once

#include "protocols/collect/server_connection.hpp"

#include <optional>
#include <span>
#include <string>

namespace touchtrial::collect {

/// The version of tables.hpp with which servers began.
inline constexpr int kFirstServerVersion = 3;

/// One step forward; runs inside a transaction.
using ServerMigration = void (*)(pqxx::work&);

/// server_migrations()[i] makes version kFirstServerVersion + i of the one before; the first of
/// them begins with nothing.
[[nodiscard]] std::span<const ServerMigration> server_migrations();

/// Nothing if the database has no tables of ours.
/// \throws StoreError if there are others under their names, or no schema to look in
[[nodiscard]] std::optional<int> server_version(ServerConnection& server);

/// Makes the tables, or brings them to the newest version, in one transaction; two programs that do
/// it at once come one after the other.
/// \throws StoreError if the tables are newer, which are left alone, or not ours
void bring_forward(ServerConnection& server,
                   std::span<const ServerMigration> steps = server_migrations());

/// \throws StoreError, with the remedy, unless the tables are there and of this version
void require_current(ServerConnection& server);

}  // namespace touchtrial::collect
