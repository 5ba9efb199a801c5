#include "record/schema.hpp"

#include "core/errors.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <utility>
#include <vector>

namespace touchtrial::record {
namespace {

// WITHOUT ROWID suits small rows with keys of several columns.
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

/// Maps the type and name of each object to its table and SQL, without blanks and line ends.
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

/// SQLite's internal tables, which a viewer's ANALYZE or AUTOINCREMENT leaves behind. They sample
/// only the keys of rows, which are unencrypted.
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

/// Quotes a word for the shell, on one line: as '...' or, with unprintable bytes, as $'...' of bash
/// and zsh.
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
    for (const int power : {64, 8, 1}) word += static_cast<char>('0' + byte / power % 8);
  }
  return word + '\'';
}

/// The command that drops objects and columns.
/// \param statements  SQL
std::string drop_command(const std::filesystem::path& database, const std::string& statements) {
  // sqlite3 would parse a name that begins like this as an option or an address.
  const std::string path = database.string();
  const bool needs_prefix = path.starts_with('-') || path.starts_with("file:");
  return "sqlite3 " + shell_word(needs_prefix ? "./" + path : path) + ' ' + shell_word(statements);
}

/// Drops foreign objects; those that depend on tables come first. Tables take their internal
/// indexes with them.
std::string drop_statements(const SchemaObjects& foreign) {
  std::string sql;
  for (const char* const type : {"trigger", "view", "index", "table"}) {
    for (const auto& [object, definition] : foreign) {
      if (object.first != type || object.second.starts_with("sqlite_autoindex_")) continue;
      std::string keyword = type;
      std::ranges::transform(keyword, keyword.begin(), [](char c) { return std::toupper(c); });
      sql += "DROP " + keyword + " IF EXISTS " + identifier(object.second) + "; ";
    }
  }
  return sql;
}

std::string drop_columns(const std::string& table, Columns columns, const Columns& expected) {
  std::string sql;
  for (const std::string& column : columns) {
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
  SchemaObjects foreign = objects_of(database.connection());
  std::string difference;
  std::string column_drops;
  for (const auto& [object, definition] : expected.objects) {
    const auto actual = foreign.extract(object);
    const std::string name = object.first + " " + object.second;
    if (actual.empty()) return SchemaFault{name + " is missing from the schema", ""};
    if (actual.mapped() == definition) continue;
    if (difference.empty()) difference = name + " differs from the schema";
    const auto table = expected.columns.find(object.second);
    const std::string drops =
        table == expected.columns.end()
            ? ""
            : drop_columns(table->first, columns_of(database.connection(), table->first),
                           table->second);
    if (drops.empty()) return SchemaFault{difference, ""};
    column_drops += drops;
  }
  std::erase_if(foreign, [](const auto& object) {
    const auto harmless = harmless_objects().find(object.first);
    return harmless != harmless_objects().end() && harmless->second == object.second;
  });
  const std::string statements = drop_statements(foreign) + column_drops;
  if (difference.empty() && !foreign.empty()) {
    const auto& [type, name] = foreign.begin()->first;
    difference = one_line(type + " " + name) + " does not belong to the schema";
  }
  if (difference.empty()) return std::nullopt;
  return SchemaFault{difference,
                     statements.empty() ? "" : drop_command(database.path(), statements)};
}

}  // namespace touchtrial::record
