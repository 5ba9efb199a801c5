/// \file Rows of the derived tables sessions, trials and responses. Private to protocols/store.
/// All functions throw SQLite::Exception; call them inside Database::run.
#pragma once

#include "protocols/store/database.hpp"
#include "protocols/store/fold.hpp"

#include <vector>

namespace touchtrial::store {

/// By session. \throws EventFault if a row holds what no event gives rise to
[[nodiscard]] std::vector<SessionRow> read_sessions(const Database& database);
/// By session and trial. \throws the same
[[nodiscard]] std::vector<TrialRow> read_trials(const Database& database);

/// The rows that `scope` names, as far as they exist. \throws the same
[[nodiscard]] DerivedRows read_rows(const Database& database, const FoldScope& scope);
/// Adds or changes every row of `rows`.
void write_rows(const Database& database, const DerivedRows& rows);
void delete_all_rows(const Database& database);

}  // namespace touchtrial::store
