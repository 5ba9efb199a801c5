#include "record/schema.hpp"

#include "core/errors.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <utility>
#include <vector>

namespace touchtrial::record {
namespace {

/// WITHOUT ROWID for small rows with keys of several columns.
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

/// By type and name: an object's table, and its SQL without blanks and line ends.
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

/// SQLite's internal tables, which a viewer's ANALYZE or AUTOINCREMENT leaves behind. Its
/// statistics sample only the keys of rows, which are in clear.
const SchemaObjects& harmless_objects() {
  static const auto table = [](std::string name, const std::string& columns) {
    std::string sql = name + " CREATETABLE" + name + "(" + columns + ")";
    return SchemaObjects::value_type({"table", std::move(name)}, std::move(sql));
  };
  static const SchemaObjects objects = {table("sqlite_sequence", "name,seq"),
                                        table("sqlite_stat1", "tbl,idx,stat"),
                                        table("sqlite_stat2", "tbl,idx,sampleno,sample"),
                                        table("sqlite_stat3", "tbl,idx,neq,nlt,ndlt,sample"),
                                        table("sqlite_stat4", "tbl,idx,neq,nlt,ndlt,sample")};
  return objects;
}

using Columns = std::vector<std::string>;

Columns columns_of(SQLite::Database& connection, const std::string& table) {
  SQLite::Statement query(connection, "SELECT name FROM pragma_table_xinfo(?)");
  query.bind(1, table);
  Columns columns;
  while (query.executeStep()) columns.push_back(query.getColumn(0).getString());
  return columns;
}

struct Schema {
  SchemaObjects objects;
  std::map<std::string, Columns> columns;  ///< by table
};

Schema expected_schema() {
  SQLite::Database empty(":memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  empty.exec(schema_sql());
  Schema schema{objects_of(empty), {}};
  for (const char* const table : kTables) schema.columns[table] = columns_of(empty, table);
  return schema;
}

std::string identifier(const std::string& name) {
  std::string quoted = "\"";
  for (const char c : name) quoted.append(c == '"' ? 2 : 1, c);
  return quoted + '"';
}

/// A quoted shell word, on one line: '...' or, with unprintable bytes, $'...' of bash and zsh.
std::string shell_word(const std::string& text) {
  if (one_line(text) == text) {
    std::string word = "'";
    for (const char c : text) word += c == '\'' ? std::string(R"('\'')") : std::string(1, c);
    return word + '\'';
  }
  std::string word = "$'";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain = byte >= ' ' && byte < 0x7f && c != '\'' && c != '\\';
    if (is_plain) {
      word += c;
      continue;
    }
    word += '\\';
    for (const int place : {64, 8, 1}) word += static_cast<char>('0' + byte / place % 8);
  }
  return word + '\'';
}

/// The command that drops objects and columns.
/// \param statements  SQL
std::string drop_command(const std::filesystem::path& database, const std::string& statements) {
  // sqlite3 would parse a name that begins like this as an option or an address.
  const std::string path = database.string();
  const bool is_name = path.starts_with('-') || path.starts_with("file:");
  return "sqlite3 " + shell_word(is_name ? "./" + path : path) + ' ' + shell_word(statements);
}

/// Drops foreign objects: first those that depend on tables.
/// \param alien  objects; internal indexes go with their tables
std::string drop_statements(const SchemaObjects& alien) {
  std::string sql;
  for (const char* const type : {"trigger", "view", "index", "table"}) {
    for (const auto& [object, made_by] : alien) {
      if (object.first != type || object.second.starts_with("sqlite_autoindex_")) continue;
      std::string keyword = type;
      std::ranges::transform(keyword, keyword.begin(), [](char c) { return std::toupper(c); });
      sql += "DROP " + keyword + " IF EXISTS " + identifier(object.second) + "; ";
    }
  }
  return sql;
}

std::string drop_columns(const std::string& table, Columns found, const Columns& expected) {
  std::string sql;
  for (const std::string& column : found) {
    if (std::ranges::find(expected, column) != expected.end()) continue;
    sql += "ALTER TABLE " + table + " DROP COLUMN " + identifier(column) + "; ";
  }
  return sql;
}

}  // namespace

void make_tables(const Database& database) {
  database.change([&] {
    database.connection().exec(schema_sql());
    database.connection().exec("PRAGMA user_version = " + std::to_string(kSchemaVersion));
  });
}

std::optional<SchemaFault> schema_fault(const Database& database) {
  static const Schema expected = expected_schema();
  SchemaObjects alien = objects_of(database.connection());
  std::string what;
  std::string columns;
  for (const auto& [object, made_by] : expected.objects) {
    const auto same = alien.extract(object);
    const std::string name = object.first + " " + object.second;
    if (same.empty()) return SchemaFault{name + " is missing from the schema", ""};
    if (same.mapped() == made_by) continue;
    if (what.empty()) what = name + " is not as its schema has it";
    const auto own = expected.columns.find(object.second);
    const std::string more =
        own == expected.columns.end()
            ? ""
            : drop_columns(own->first, columns_of(database.connection(), own->first), own->second);
    if (more.empty()) return SchemaFault{what, ""};
    columns += more;
  }
  std::erase_if(alien, [](const auto& object) {
    const auto harmless = harmless_objects().find(object.first);
    return harmless != harmless_objects().end() && harmless->second == object.second;
  });
  const std::string statements = drop_statements(alien) + columns;
  if (what.empty() && !alien.empty()) {
    const auto& [type, name] = alien.begin()->first;
    what = one_line(type + " " + name) + " does not belong to the schema";
  }
  if (what.empty()) return std::nullopt;
  return SchemaFault{what, statements.empty() ? "" : drop_command(database.path(), statements)};
}

}  // namespace touchtrial::record
