#include "protocols/rating/analysis/rating_model.hpp"

#include "core/text.hpp"
#include "protocols/rating/analysis/tables.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis::rating {
namespace {

/// The rows of ratings.csv that are scored.
DataTable model_table(const Outcomes& outcomes) {
  DataTable table = ratings_table(outcomes);
  const auto kind = std::ranges::find(table.columns, "kind") - table.columns.begin();
  const DataCell scored = std::string(name_of(study::Role::scored));
  std::erase_if(table.rows, [&](const std::vector<DataCell>& row) {
    return row[static_cast<std::size_t>(kind)] != scored;
  });
  return table;
}

constexpr const char* kModelNotes =
    "`rating_model.csv` has one row per scale of each counted answer. `Rscript rating_model.R` "
    "prints two analyses for each scale; with `--csv`, all digits.\n\n1. Student's t over "
    "participants' differences between methods: the report's, and the result to quote.\n2. A "
    "linear mixed model (lme4, sum-coded):\n\n       rating ~ method * class + (1 + method + class "
    "| participant)\n\n   If it is singular or does not converge, the same with `||` in place of "
    "`|`, then with `(1 + method | participant)`, then with `||` there too; the script prints "
    "which. If all fail, there is no model: one in which people differ only in level takes chance "
    "for a difference between methods too often. A difference is over all classes. Intervals and p "
    "have as many degrees of freedom as participants, minus one.\n\nThe model treats ratings as "
    "unbounded numbers with equal variance. If many are at an end of the scale, or points are few, "
    "a model of ordered categories is better (R's `ordinal::clmm`).\n";

}  // namespace

RModel rating_model(const Outcomes& outcomes) {
  return {"Rating model", "rating_model", model_table(outcomes),
          fmt::format("methods <- c({})\n\n{}", listed(outcomes.methods, ", ", r_text),
                      rating_model_functions()),
          kModelNotes};
}

}  // namespace touchtrial::analysis::rating
