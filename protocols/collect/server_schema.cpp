#include "protocols/collect/server_schema.hpp"

#include <array>

namespace touchtrial::collect {
namespace {

// A station's name, for messages, is that of its file at its first push. Session numbers come from
// a sequence, so that two stations can push at once; gaps in them mean nothing.
constexpr const char* kServerAlone = R"sql(
CREATE TABLE touchtrial_schema(
  one     BOOLEAN PRIMARY KEY DEFAULT TRUE CHECK(one),
  version INTEGER NOT NULL
);
CREATE TABLE stations(
  station  INTEGER PRIMARY KEY,
  identity BYTEA NOT NULL UNIQUE,
  name     TEXT NOT NULL
);
CREATE SEQUENCE session_numbers AS INTEGER;
CREATE FUNCTION touchtrial_append_only() RETURNS trigger LANGUAGE plpgsql AS
  $$ BEGIN RAISE EXCEPTION '% are append-only', TG_TABLE_NAME; END $$;
)sql";

std::string table_sql(const store::TableDefinition& table) {
  const std::string name(table.name);
  std::string sql =
      store::create_table_sql(table, kServerTypes) + ";\n" + store::create_indices_sql(table);
  if (table.append_only) {
    sql += "CREATE TRIGGER " + name + "_append_only BEFORE UPDATE OR DELETE OR TRUNCATE ON " +
           name + " FOR EACH STATEMENT EXECUTE FUNCTION touchtrial_append_only();";
  }
  for (const store::TableColumn& column : table.columns) {
    // Trying to compress them would take longer than the rest of storing them.
    if (column.bulky) {
      sql += "ALTER TABLE " + name + " ALTER COLUMN " + std::string(column.name) +
             " SET STORAGE EXTERNAL;";
    }
  }
  return sql;
}

void make_tables(pqxx::work& work) {
  work.exec(kServerAlone);
  for (const store::TableDefinition& table : store::table_definitions()) {
    if (!table.at_stations_alone) work.exec(table_sql(table));
  }
  work.exec("CREATE UNIQUE INDEX sessions_of_station ON sessions(station, own_session)");
  work.exec_params0("INSERT INTO touchtrial_schema(version) VALUES($1)", store::kSchemaVersion);
}

constexpr std::array<ServerMigration, store::kSchemaVersion - store::kOldestSchemaVersion>
    kMigrations = {};

std::string our_names() {
  std::string names = "{stations";
  for (const store::TableDefinition& table : store::table_definitions())
    names += "," + std::string(table.name);
  return names + "}";
}

std::optional<int> version_in(pqxx::work& work, const ServerConnection& server) {
  const auto place = work.exec1("SELECT current_schema()")[0];
  if (place.is_null()) {
    server.refuse("the search_path names no schema that exists; make it with CREATE SCHEMA");
  }
  const auto tables_named = [&](const std::string& names) {
    return work
        .exec_params1(
            "SELECT count(*) FROM pg_class c JOIN pg_namespace n ON n.oid = c.relnamespace "
            "WHERE n.nspname = current_schema() AND c.relkind IN ('r','p','v','m','f') "
            "AND c.relname = ANY($1::text[])",
            names)[0]
        .as<int>();
  };
  if (tables_named("{touchtrial_schema}") > 0) {
    return work.exec1("SELECT version FROM touchtrial_schema")[0].as<int>();
  }
  if (tables_named(our_names()) > 0) {
    server.refuse(
        "has tables of another program under the names that Touchtrial uses; make a database for "
        "the study alone (createdb), or a schema of its own");
  }
  return std::nullopt;
}

/// \throws StoreError if the tables are of a version that is not known here
void require_known(const ServerConnection& server, int version, int newest) {
  if (version > newest) {
    server.refuse("was written by a newer Touchtrial (schema " + std::to_string(version) +
                  ", this one knows " + std::to_string(newest) + "); install that");
  }
  if (version < store::kOldestSchemaVersion) {
    server.refuse("was written by an older Touchtrial (schema " + std::to_string(version) +
                  ", the oldest that this one knows is " +
                  std::to_string(store::kOldestSchemaVersion) + "); use the program that wrote it");
  }
}

}  // namespace

std::span<const ServerMigration> server_migrations() {
  return kMigrations;
}

std::optional<int> server_version(ServerConnection& server) {
  return server.look([&](pqxx::work& work) { return version_in(work, server); });
}

void bring_forward(ServerConnection& server, std::span<const ServerMigration> steps) {
  const int newest = store::kOldestSchemaVersion + static_cast<int>(steps.size());
  const auto is_current = [&](std::optional<int> version) {
    if (version) require_known(server, *version, newest);
    return version == newest;
  };
  // A role that may only add rows must not need further rights.
  if (is_current(server_version(server))) return;
  server.change([&](pqxx::work& work) {
    work.exec(
        "SELECT pg_advisory_xact_lock(hashtextextended('touchtrial ' || current_schema(), 0))");
    const std::optional<int> version = version_in(work, server);
    if (is_current(version)) return;
    if (!version) return make_tables(work);
    const auto done = static_cast<std::size_t>(*version - store::kOldestSchemaVersion);
    for (const ServerMigration step : steps.subspan(done)) step(work);
    work.exec_params0("UPDATE touchtrial_schema SET version = $1", newest);
  });
}

void require_current(ServerConnection& server) {
  const std::optional<int> version = server_version(server);
  if (!version) server.refuse("holds no study yet; push one with `touchtrial sync`");
  require_known(server, *version, store::kSchemaVersion);
  if (*version < store::kSchemaVersion) {
    server.refuse("is of an older schema; the next `touchtrial sync` brings it up to date");
  }
}

}  // namespace touchtrial::collect
