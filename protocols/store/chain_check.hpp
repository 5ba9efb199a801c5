/// \file Finds the first thing in a database that does not hold.
#pragma once

#include "protocols/store/database.hpp"
#include "protocols/store/study_store.hpp"

#include <optional>

namespace touchtrial::store {

/// Looks, in this order, at the file's structure, its chain, every session's chain, what the file's
/// chain says of the sessions, keys, traces, the derived tables, and the schema; structure and
/// traces may be left out. Call inside Database::run and a transaction.
[[nodiscard]] std::optional<ChainFault> find_first_fault(const Database& database,
                                                         TraceCheck traces);

}  // namespace touchtrial::store
