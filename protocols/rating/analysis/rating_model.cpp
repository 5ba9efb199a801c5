#include "protocols/rating/analysis/rating_model.hpp"

#include "analysis/exports/data_table.hpp"
#include "analysis/exports/export_folder.hpp"
#include "core/errors.hpp"
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

std::string notes_on_model(const Outcomes& outcomes) {
  return fmt::format(
      "# Rating model of {}\n\n{}`rating_model.csv` has one row for each scale of each answered "
      "trial that counts. `Rscript rating_model.R` prints, for each scale, two analyses; with "
      "`--csv`, all their digits.\n\n1. Student's t over participants' own differences between "
      "methods: the report's, and the result to quote.\n2. A linear mixed model (lme4, sum-coded)"
      ":\n\n       rating ~ method * class + (1 + method + class | participant)\n\n   If it is "
      "singular or does not converge, the same with `||` in place of `|`, then with `(1 + method | "
      "participant)`, then with `||` there too; the script says which. If none does, there is no "
      "model: one in which people differ in their level alone takes chance for a difference "
      "between "
      "methods too often. A difference is over all classes. Intervals and p have as many degrees "
      "of "
      "freedom as participants, less one.\n\nThe model takes ratings as numbers without ends and "
      "with equal scatter. Where many lie at an end of the scale, or points are few, a model of "
      "ordered categories suits them better (R's `ordinal::clmm`).\n",
      one_line(outcomes.study),
      outcomes.simulated ? "SIMULATED: every participant is a program.\n\n" : "");
}

}  // namespace

std::string rating_model_script(const Outcomes& outcomes) {
  return fmt::format(
             "# Rating model of the study {}{}. Run: Rscript rating_model.R\n"
             "# Needs lme4; reads rating_model.csv beside this file. What it means: "
             "rating_model.md.\nmethods <- c({})\n\n",
             one_line(outcomes.study), outcomes.simulated ? " (SIMULATED)" : "",
             listed(outcomes.methods, ", ", r_text)) +
         std::string(rating_model_functions());
}

std::vector<std::filesystem::path> export_rating_model(const record::StudyStore& store,
                                                       const Outcomes& outcomes,
                                                       const std::filesystem::path& folder) {
  const record::StudyCommitment& commitment = store.commitment();
  return write_export(folder, {commitment.study, commitment.study_id, "r"},
                      {text_file("rating_model.csv", csv_text(model_table(outcomes))),
                       text_file("rating_model.R", rating_model_script(outcomes)),
                       text_file("rating_model.md", notes_on_model(outcomes))});
}

}  // namespace touchtrial::analysis::rating
