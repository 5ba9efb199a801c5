#include "protocols/store/schema.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace touchtrial::store {
namespace {

constexpr std::array<Migration, kSchemaVersion - kOldestSchemaVersion> kMigrations = {
    [](SQLite::Database& database) { database.exec(add_visits_sql("INTEGER")); }};

/// All others are WITHOUT ROWID, which suits small rows under keys of several columns.
bool has_row_numbers(const TableDefinition& table) {
  return table.key.size() == 1 || std::ranges::any_of(table.columns, &TableColumn::bulky);
}

/// REPLACE deletes rows without running the delete trigger, so a third trigger refuses to insert
/// over an existing row.
std::string append_only_sql(const TableDefinition& table) {
  const std::string name(table.name);
  std::string same_key;
  for (const std::string_view column : table.key) {
    same_key +=
        (same_key.empty() ? "" : " AND ") + std::string(column) + " = NEW." + std::string(column);
  }
  const std::string refusal =
      "\n  BEGIN SELECT RAISE(ABORT, '" + name + " are append-only'); END;\n";
  return "CREATE TRIGGER " + name + "_no_update BEFORE UPDATE ON " + name + refusal +
         "CREATE TRIGGER " + name + "_no_delete BEFORE DELETE ON " + name + refusal +
         "CREATE TRIGGER " + name + "_no_replace BEFORE INSERT ON " + name +
         "\n  WHEN EXISTS(SELECT 1 FROM " + name + " WHERE " + same_key + ")" + refusal;
}

std::string schema_sql() {
  std::string sql;
  for (const TableDefinition& table : table_definitions()) {
    sql += create_table_sql(table, {"INTEGER", "REAL", "TEXT", "BLOB"}) + " STRICT" +
           (has_row_numbers(table) ? ";\n" : ", WITHOUT ROWID;\n") + create_indices_sql(table);
    if (table.append_only) sql += append_only_sql(table);
  }
  return sql;
}

void set_version(SQLite::Database& connection, int version) {
  connection.exec("PRAGMA user_version = " + std::to_string(version));
}

void bring_forward(const Database& database, std::span<const Migration> steps) {
  const auto done = static_cast<std::size_t>(schema_version(database) - kOldestSchemaVersion);
  if (done >= steps.size()) return;
  database.change([&] {
    for (const Migration step : steps.subspan(done)) step(database.connection());
    set_version(database.connection(), kOldestSchemaVersion + static_cast<int>(steps.size()));
  });
  database.run([&] { database.checkpoint(); });
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

std::span<const Migration> migrations() {
  return kMigrations;
}

void make_tables(const Database& database) {
  database.change([&] {
    database.connection().exec(schema_sql());
    set_version(database.connection(), kSchemaVersion);
  });
}

Database open_current(const std::filesystem::path& path, Database::Mode mode,
                      std::span<const Migration> steps) {
  const int newest = kOldestSchemaVersion + static_cast<int>(steps.size());
  Database database = Database::open(path, mode, newest);
  if (mode == Database::Mode::read_write) {
    bring_forward(database, steps);
  } else if (schema_version(database) < newest) {
    throw StoreError(
        database.refusal("is of an older schema; copy it, and bring it up to date with `touchtrial "
                         "migrate`"));
  }
  return database;
}

int schema_version(const Database& database) {
  return database.run(
      [&] { return database.connection().execAndGet("PRAGMA user_version").getInt(); });
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
