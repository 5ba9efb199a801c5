#include "protocols/collect/server_schema.hpp"

#include <array>

namespace touchtrial::collect {
namespace {

// A station's name, for messages, is that of its file at its first push. A role that was admitted
// is one station, and every number of a session tells the station (server_session), so that what a
// role may add follows from the numbers alone.
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
CREATE TABLE station_roles(
  station INTEGER PRIMARY KEY CHECK(station BETWEEN 1 AND 20000),
  role    NAME NOT NULL UNIQUE
);
CREATE FUNCTION touchtrial_append_only() RETURNS trigger LANGUAGE plpgsql AS
  $$ BEGIN RAISE EXCEPTION '% are append-only', TG_TABLE_NAME; END $$;
)sql";

// Functions with the owner's rights ask for session_user, which stays who logged in, and look for
// tables in the study's schema alone ("SCHEMA" becomes its name), so that nobody can lay others in
// their way. A role that may not LOCK, UPDATE or DELETE cannot hinder another one's push: locks
// that a push takes are on the role's own rows. Decision 42.
constexpr const char* kRights = R"sql(
CREATE FUNCTION touchtrial_station() RETURNS INTEGER LANGUAGE sql STABLE SECURITY DEFINER
  SET search_path = SCHEMA, pg_temp AS
  $$ SELECT station FROM station_roles WHERE role = session_user $$;
CREATE FUNCTION touchtrial_station_of(number BIGINT) RETURNS BIGINT LANGUAGE sql IMMUTABLE AS
  $$ SELECT CASE WHEN number < 0 THEN -number WHEN number > 0 THEN (number - 1) / 100000 + 1 END $$;
CREATE FUNCTION touchtrial_is_owner() RETURNS BOOLEAN LANGUAGE sql STABLE SECURITY DEFINER
  SET search_path = SCHEMA, pg_temp AS
  $$ SELECT pg_has_role(session_user, current_user, 'MEMBER') $$;
CREATE FUNCTION touchtrial_lock_station(of_identity BYTEA) RETURNS VOID LANGUAGE plpgsql
  SECURITY DEFINER SET search_path = SCHEMA, pg_temp AS $$
  BEGIN
    IF touchtrial_station() IS NOT NULL THEN
      PERFORM FROM station_roles WHERE role = session_user FOR UPDATE;
    ELSIF touchtrial_is_owner() THEN
      PERFORM FROM stations WHERE identity = of_identity FOR UPDATE;
      IF NOT FOUND THEN
        LOCK TABLE stations IN SHARE ROW EXCLUSIVE MODE;
      END IF;
    ELSE
      RAISE insufficient_privilege USING MESSAGE =
        'permission denied: the role is no station of this study (touchtrial_admit)';
    END IF;
  END $$;
CREATE FUNCTION touchtrial_next_station() RETURNS INTEGER LANGUAGE sql SECURITY DEFINER
  SET search_path = SCHEMA, pg_temp AS
  $$ SELECT coalesce(touchtrial_station(), 1 + greatest(
       (SELECT coalesce(max(station), 0) FROM stations),
       (SELECT coalesce(max(station), 0) FROM station_roles))) $$;
CREATE FUNCTION touchtrial_destroy_key(number BIGINT, of_safety BOOLEAN DEFAULT FALSE)
  RETURNS BIGINT LANGUAGE plpgsql SECURITY DEFINER SET search_path = SCHEMA, pg_temp AS $$
  DECLARE destroyed BIGINT;
  BEGIN
    IF touchtrial_station_of(number) IS DISTINCT FROM touchtrial_station()
       AND NOT touchtrial_is_owner() THEN
      RAISE insufficient_privilege USING MESSAGE =
        'permission denied: the session is another station''s';
    END IF;
    IF of_safety THEN
      DELETE FROM safety_keys WHERE session = number;
    ELSE
      DELETE FROM participant_keys WHERE session = number;
    END IF;
    GET DIAGNOSTICS destroyed = ROW_COUNT;
    RETURN destroyed;
  END $$;
CREATE FUNCTION touchtrial_admit(login NAME, number INTEGER DEFAULT NULL) RETURNS INTEGER
  LANGUAGE plpgsql SET search_path = SCHEMA, pg_temp AS $$
  DECLARE admitted INTEGER;
  BEGIN
    LOCK TABLE stations IN SHARE ROW EXCLUSIVE MODE;
    INSERT INTO station_roles VALUES(coalesce(number, touchtrial_next_station()), login)
      ON CONFLICT(role) DO NOTHING;
    EXECUTE format('GRANT USAGE ON SCHEMA %I TO %I', current_schema(), login);
    EXECUTE format('GRANT SELECT ON touchtrial_schema TO %I', login);
    EXECUTE format('GRANT SELECT, INSERT ON stations, sessions, events, traces, participant_keys, '
      'safety_keys, trials TO %I', login);
    EXECUTE format('GRANT UPDATE(excluded, withdrawn, erased, replaced_by) ON sessions TO %I',
      login);
    EXECUTE format('GRANT EXECUTE ON FUNCTION touchtrial_lock_station(BYTEA), '
      'touchtrial_next_station(), touchtrial_destroy_key(BIGINT, BOOLEAN) TO %I', login);
    SELECT station INTO admitted FROM station_roles WHERE role = login;
    RETURN admitted;
  END $$;
REVOKE ALL ON FUNCTION touchtrial_lock_station(BYTEA), touchtrial_next_station(),
  touchtrial_destroy_key(BIGINT, BOOLEAN), touchtrial_admit(NAME, INTEGER) FROM PUBLIC;
ALTER TABLE stations ENABLE ROW LEVEL SECURITY;
CREATE POLICY everybody_reads ON stations FOR SELECT USING (TRUE);
CREATE POLICY station_adds_itself ON stations FOR INSERT
  WITH CHECK (station = (SELECT touchtrial_station()));
CREATE POLICY station_marks_its_own ON sessions FOR UPDATE
  USING (station = (SELECT touchtrial_station()))
  WITH CHECK (station = (SELECT touchtrial_station()));
)sql";

/// Everybody who was granted a table reads it, but a station reads its own keys alone; a station
/// adds rows of its own sessions and chain.
std::string row_rights_sql(const TableDefinition& table) {
  const std::string name(table.name);
  const std::string own = "touchtrial_station_of(session) = (SELECT touchtrial_station())";
  const bool is_sessions = &table == &table_definition(Table::sessions);
  const bool is_keys = name == "participant_keys" || name == "safety_keys";
  return "ALTER TABLE " + name + " ENABLE ROW LEVEL SECURITY;\nCREATE POLICY everybody_reads ON " +
         name + " FOR SELECT USING (" +
         (is_keys ? "(SELECT touchtrial_station()) IS NULL OR " + own : "TRUE") +
         ");\nCREATE POLICY station_adds_its_own ON " + name + " FOR INSERT WITH CHECK (" + own +
         (is_sessions ? " AND station = (SELECT touchtrial_station())" : "") + ");\n";
}

/// The statements, with the name of the schema in them.
std::string in_schema(std::string sql, const std::string& schema) {
  const std::string place = "SCHEMA, pg_temp";
  for (std::size_t at = 0; (at = sql.find(place, at)) != std::string::npos; at += schema.size()) {
    sql.replace(at, place.find(','), schema);
  }
  return sql;
}

std::string table_sql(const TableDefinition& table) {
  const std::string name(table.name);
  std::string sql = create_table_sql(table, kServerTypes) + ";\n" + create_indices_sql(table);
  if (table.append_only) {
    sql += "CREATE TRIGGER " + name + "_append_only BEFORE UPDATE OR DELETE OR TRUNCATE ON " +
           name + " FOR EACH STATEMENT EXECUTE FUNCTION touchtrial_append_only();";
  }
  for (const TableColumn& column : table.columns) {
    // Trying to compress them would take longer than the rest of storing them.
    if (column.bulky) {
      sql += "ALTER TABLE " + name + " ALTER COLUMN " + std::string(column.name) +
             " SET STORAGE EXTERNAL;";
    }
  }
  return sql;
}

void make_tables(ServerWork& work) {
  work.exec(kServerAlone);
  for (const TableDefinition& table : table_definitions()) {
    if (!table.at_stations_alone) work.exec(table_sql(table));
  }
  work.exec("CREATE UNIQUE INDEX sessions_of_station ON sessions(station, own_session)");
  const auto schema = work.exec1("SELECT quote_ident(current_schema())")[0].as<std::string>();
  work.exec(in_schema(kRights, schema));
  for (const TableDefinition& table : table_definitions()) {
    if (!table.at_stations_alone) work.exec(row_rights_sql(table));
  }
  work.exec0("INSERT INTO touchtrial_schema(version) VALUES($1)", kSchemaVersion);
}

constexpr std::array<ServerMigration, kSchemaVersion - kOldestSchemaVersion> kMigrations = {
    [](ServerWork& work) { work.exec(add_visits_sql("BIGINT")); }};

std::string our_names() {
  std::string names = "{stations,station_roles";
  for (const TableDefinition& table : table_definitions()) names += "," + std::string(table.name);
  return names + "}";
}

std::optional<int> version_in(ServerWork& work, const ServerConnection& server) {
  const auto place = work.exec1("SELECT current_schema()")[0];
  if (place.is_null()) {
    server.refuse("the search_path names no schema that exists; make it with CREATE SCHEMA");
  }
  const auto tables_named = [&](const std::string& names) {
    return work
        .exec1(
            "SELECT count(*) FROM pg_class c JOIN pg_namespace n ON n.oid = c.relnamespace "
            "WHERE n.nspname = current_schema() AND c.relkind IN ('r','p','v','m','f') "
            "AND c.relname = ANY($1::text[])",
            names)[0]
        .as<int>();
  };
  if (tables_named("{touchtrial_schema}") > 0) {
    if (tables_named("{station_roles}") == 0) {
      server.refuse(
          "was made by an earlier Touchtrial, which let every station alter the others' rows; make "
          "a "
          "new database (createdb) and sync all stations to it");
    }
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
  if (version < kOldestSchemaVersion) {
    server.refuse("was written by an older Touchtrial (schema " + std::to_string(version) +
                  ", the oldest that this one knows is " + std::to_string(kOldestSchemaVersion) +
                  "); use the program that wrote it");
  }
}

}  // namespace

std::span<const ServerMigration> server_migrations() {
  return kMigrations;
}

std::optional<int> server_version(ServerConnection& server) {
  return server.look([&](ServerWork& work) { return version_in(work, server); });
}

void bring_forward(ServerConnection& server, std::span<const ServerMigration> steps) {
  const int newest = kOldestSchemaVersion + static_cast<int>(steps.size());
  const auto is_current = [&](std::optional<int> version) {
    if (version) require_known(server, *version, newest);
    return version == newest;
  };
  // A role that may only add rows must not need further rights.
  if (is_current(server_version(server))) return;
  server.change([&](ServerWork& work) {
    work.exec(
        "SELECT pg_advisory_xact_lock(hashtextextended('touchtrial ' || current_schema(), 0))");
    const std::optional<int> version = version_in(work, server);
    if (is_current(version)) return;
    if (!version) return make_tables(work);
    const auto done = static_cast<std::size_t>(*version - kOldestSchemaVersion);
    for (const ServerMigration step : steps.subspan(done)) step(work);
    work.exec0("UPDATE touchtrial_schema SET version = $1", newest);
  });
}

void require_current(ServerConnection& server) {
  const std::optional<int> version = server_version(server);
  if (!version) server.refuse("holds no study yet; push one with `touchtrial sync`");
  require_known(server, *version, kSchemaVersion);
  if (*version < kSchemaVersion) {
    server.refuse("is of an older schema; the next `touchtrial sync` brings it up to date");
  }
}

}  // namespace touchtrial::collect
