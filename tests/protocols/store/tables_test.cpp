// Compares the description of the tables with what SQLite makes of it.
#include "protocols/store/tables.hpp"

#include "core/hash.hpp"
#include "protocols/store/schema.hpp"
#include "support/catch.hpp"

#include <map>
#include <set>
#include <string>
#include <vector>

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

using namespace touchtrial;
using namespace touchtrial::store;

namespace {

struct NewDatabase {
  NewDatabase() { make_tables(made); }
  Database made = Database::temporary("new");
  SQLite::Database& database = made.connection();
};

std::string name_of(ColumnType type) {
  switch (type) {
    case ColumnType::integer:
      return "INTEGER";
    case ColumnType::real:
      return "REAL";
    case ColumnType::text:
      return "TEXT";
    case ColumnType::blob:
      return "BLOB";
  }
  return "";
}

/// For each column in order: name, type, whether it may be null, default; then the columns of the
/// key.
using Lines = std::vector<std::string>;

Lines described(const TableDefinition& table) {
  Lines lines;
  for (const TableColumn& column : table.columns) {
    lines.push_back(std::string(column.name) + ' ' + name_of(column.type) +
                    (column.nullable ? " nullable" : "") +
                    (column.default_value.empty() ? "" : " = ") +
                    std::string(column.default_value));
  }
  for (const std::string_view name : table.key) lines.push_back("key " + std::string(name));
  return lines;
}

Lines found(SQLite::Database& database, const std::string& table) {
  Lines lines;
  std::map<int, std::string> key;
  SQLite::Statement query(database,
                          "SELECT name, type, \"notnull\", coalesce(dflt_value, ''), pk FROM "
                          "pragma_table_info(?) ORDER BY cid");
  query.bind(1, table);
  while (query.executeStep()) {
    const std::string name = query.getColumn(0).getString();
    const std::string value = query.getColumn(3).getString();
    const int place = query.getColumn(4).getInt();
    // A row's number is never NULL, though SQLite does not say so.
    const bool nullable = query.getColumn(2).getInt() == 0 && place == 0;
    lines.push_back(name + ' ' + query.getColumn(1).getString() + (nullable ? " nullable" : "") +
                    (value.empty() ? "" : " = ") + value);
    if (place > 0) key[place] = name;
  }
  for (const auto& [place, name] : key) lines.push_back("key " + name);
  return lines;
}

std::string index_sql(SQLite::Database& database, const std::string& name) {
  SQLite::Statement query(database,
                          "SELECT sql FROM sqlite_schema WHERE type = 'index' AND name = ?");
  query.bind(1, name);
  return query.executeStep() ? query.getColumn(0).getString() : "";
}

std::set<std::string> names_of(SQLite::Database& database, const std::string& type) {
  SQLite::Statement query(database,
                          "SELECT name FROM sqlite_schema WHERE type = ? AND sql IS NOT NULL");
  query.bind(1, type);
  std::set<std::string> names;
  while (query.executeStep()) names.insert(query.getColumn(0).getString());
  return names;
}

}  // namespace

TEST_CASE("the tables of a new database are those that are described") {
  const NewDatabase fresh;
  SQLite::Database& database = fresh.database;
  std::set<std::string> names;
  for (const TableDefinition& table : table_definitions()) {
    names.emplace(table.name);
    CHECK(found(database, std::string(table.name)) == described(table));
  }
  CHECK(names_of(database, "table") == names);
}

TEST_CASE("unique columns are described as the indices of a new database have them") {
  const NewDatabase fresh;
  SQLite::Database& database = fresh.database;
  std::set<std::string> names;
  for (const TableDefinition& table : table_definitions()) {
    for (const UniqueIndex& index : table.unique) {
      names.emplace(index.name);
      CHECK(index_sql(database, std::string(index.name)) ==
            "CREATE UNIQUE INDEX " + std::string(index.name) + " ON " + std::string(table.name) +
                "(" + std::string(index.columns) + ") WHERE " + std::string(index.where));
    }
  }
  CHECK(names_of(database, "index") == names);
}

TEST_CASE("tables are append-only where a new database has triggers that say so") {
  const NewDatabase fresh;
  SQLite::Database& database = fresh.database;
  std::set<std::string> expected;
  for (const TableDefinition& table : table_definitions()) {
    if (!table.append_only) continue;
    for (const char* const act : {"_no_update", "_no_delete", "_no_replace"}) {
      expected.insert(std::string(table.name) + act);
    }
  }
  CHECK(names_of(database, "trigger") == expected);
}

TEST_CASE("tables refer to each other as a new database's do, and to tables before them") {
  const NewDatabase fresh;
  SQLite::Database& database = fresh.database;
  std::set<std::string> before;
  for (const TableDefinition& table : table_definitions()) {
    Lines described;
    for (const TableReference& reference : table.references) {
      CHECK(before.contains(std::string(reference.table)));
      const std::string column(reference.column);
      described.push_back(std::string(reference.table) + ' ' + column + ' ' + column);
    }
    SQLite::Statement query(database,
                            "SELECT \"table\", \"from\", \"to\" FROM pragma_foreign_key_list(?)");
    query.bind(1, std::string(table.name));
    Lines found;
    while (query.executeStep()) {
      found.push_back(query.getColumn(0).getString() + ' ' + query.getColumn(1).getString() + ' ' +
                      query.getColumn(2).getString());
    }
    CHECK(found == described);
    before.emplace(table.name);
  }
}

// A change of the tables needs a new version, and a migration step that leads to it.
TEST_CASE("version 6 of the tables stays what it is") {
  const NewDatabase fresh;
  SQLite::Statement query(fresh.database,
                          "SELECT type || ' ' || name || ' ' || tbl_name || ' ' || coalesce(sql, "
                          "'') FROM sqlite_schema ORDER BY type, name");
  std::string text;
  while (query.executeStep()) {
    std::string object = query.getColumn(0).getString();
    std::erase_if(object, [](char c) { return c == ' ' || c == '\n'; });
    text += object + '\n';
  }
  INFO(text);
  CHECK(kSchemaVersion == 6);
  CHECK(to_hex(sha256(bytes_of(text))) ==
        "ba9d5b34560c3970b2b5b1e408dec4413bde9cc4975e85160a6e63566bd361ff");
}
