/// \file Whether a database has the tables, indices and triggers of its schema, and no others.
/// Private to protocols/store.
#pragma once

#include "protocols/store/database.hpp"

#include <optional>
#include <string>

namespace touchtrial::store {

/// Holds every object of the schema against what the migrations make of an empty database: a
/// dropped trigger, an altered table, a view that stands in for something.
/// \return what differs, by type and name; nothing if all agrees
[[nodiscard]] std::optional<std::string> schema_fault(const Database& database);

}  // namespace touchtrial::store
