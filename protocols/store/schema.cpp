#include "protocols/store/schema.hpp"

#include <map>
#include <utility>

namespace touchtrial::store {
namespace {

/// Without row numbers where rows are small, under keys of several columns.
constexpr const char* kTablesSql = R"sql(
CREATE TABLE events(
  session INTEGER NOT NULL,
  sequence INTEGER NOT NULL,
  kind TEXT NOT NULL,
  at_ns INTEGER NOT NULL,
  body TEXT NOT NULL,
  sealed BLOB NOT NULL,
  previous BLOB NOT NULL,
  hash BLOB NOT NULL,
  signature BLOB NOT NULL,
  own_session INTEGER,
  PRIMARY KEY(session, sequence)
) STRICT, WITHOUT ROWID;
CREATE TABLE traces(
  session INTEGER NOT NULL,
  trial INTEGER NOT NULL,
  box BLOB NOT NULL,
  PRIMARY KEY(session, trial)
) STRICT;
CREATE TABLE participant_keys(session INTEGER PRIMARY KEY, wrapped BLOB NOT NULL) STRICT;
CREATE TABLE safety_keys(session INTEGER PRIMARY KEY, wrapped BLOB NOT NULL) STRICT;
CREATE TABLE station_keys(session INTEGER PRIMARY KEY, kept BLOB NOT NULL) STRICT;
)sql";

/// REPLACE deletes rows without running the delete trigger, so a third trigger refuses to insert
/// over an existing row.
std::string append_only_sql(const std::string& table, const std::string& key) {
  const std::string refusal =
      "\n  BEGIN SELECT RAISE(ABORT, '" + table + " are append-only'); END;\n";
  return "CREATE TRIGGER " + table + "_no_update BEFORE UPDATE ON " + table + refusal +
         "CREATE TRIGGER " + table + "_no_delete BEFORE DELETE ON " + table + refusal +
         "CREATE TRIGGER " + table + "_no_replace BEFORE INSERT ON " + table +
         "\n  WHEN EXISTS(SELECT 1 FROM " + table + " WHERE session = NEW.session AND " + key +
         " = NEW." + key + ")" + refusal;
}

std::string schema_sql() {
  return kTablesSql + append_only_sql("events", "sequence") + append_only_sql("traces", "trial");
}

/// By type and name: the table that an object belongs to, and its SQL without blanks and line ends.
using SchemaObjects = std::map<std::pair<std::string, std::string>, std::string>;

SchemaObjects objects_of(SQLite::Database& connection) {
  SchemaObjects objects;
  SQLite::Statement query(connection,
                          "SELECT type, name, tbl_name || ' ' || replace(replace(coalesce(sql, "
                          "''), ' ', ''), char(10), '') FROM sqlite_schema");
  while (query.executeStep()) {
    objects[{query.getColumn(0).getString(), query.getColumn(1).getString()}] =
        query.getColumn(2).getString();
  }
  return objects;
}

SchemaObjects expected_objects() {
  SQLite::Database empty(":memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  empty.exec(schema_sql());
  return objects_of(empty);
}

}  // namespace

void make_tables(const Database& database) {
  database.change([&] {
    database.connection().exec(schema_sql());
    database.connection().exec("PRAGMA user_version = " + std::to_string(kSchemaVersion));
  });
}

std::optional<std::string> schema_fault(const Database& database) {
  static const SchemaObjects expected = expected_objects();
  SchemaObjects found = objects_of(database.connection());
  for (const auto& [object, made_by] : expected) {
    const auto same = found.extract(object);
    const std::string name = object.first + " " + object.second;
    if (same.empty()) return name + " is missing from the schema";
    if (same.mapped() != made_by) return name + " is not as its schema has it";
  }
  if (found.empty()) return std::nullopt;
  const auto& [type, name] = found.begin()->first;
  return type + " " + name + " does not belong to the schema";
}

}  // namespace touchtrial::store
