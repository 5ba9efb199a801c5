#include "protocols/store/schema_check.hpp"

#include "protocols/store/schema.hpp"

#include <map>
#include <utility>

namespace touchtrial::store {
namespace {

/// By type and name: the table it belongs to, and how it was made.
using SchemaObjects = std::map<std::pair<std::string, std::string>, std::string>;

SchemaObjects objects_of(SQLite::Database& connection) {
  SchemaObjects objects;
  SQLite::Statement query(connection,
                          "SELECT type, name, tbl_name || ' ' || coalesce(sql, '') "
                          "FROM sqlite_schema");
  while (query.executeStep()) {
    objects[{query.getColumn(0).getString(), query.getColumn(1).getString()}] =
        query.getColumn(2).getString();
  }
  return objects;
}

SchemaObjects expected_objects() {
  SQLite::Database empty(":memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  for (const Migration step : migrations()) step(empty);
  return objects_of(empty);
}

}  // namespace

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
