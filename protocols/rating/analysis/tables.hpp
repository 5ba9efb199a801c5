/// \file The tables that `export --format csv` writes for ratings. Columns: docs/rating.md.
#pragma once

#include "analysis/exports/trial_tables.hpp"
#include "analysis/outcomes/outcomes.hpp"

#include <vector>

namespace touchtrial::analysis::rating {

/// ratings.csv: one row per scale of each answered trial, scored or catch, of counted sessions.
/// Class, method and exemplar of a catch trial are empty.
[[nodiscard]] DataTable ratings_table(const Outcomes& outcomes);

/// Additional columns of trial tables: the rating on each scale.
[[nodiscard]] std::vector<TrialColumn> rating_columns(const Outcomes& outcomes);

}  // namespace touchtrial::analysis::rating
