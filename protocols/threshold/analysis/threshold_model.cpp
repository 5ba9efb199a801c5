#include "protocols/threshold/analysis/threshold_model.hpp"

#include "analysis/exports/data_table.hpp"
#include "analysis/exports/export_folder.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "core/errors.hpp"
#include "protocols/threshold/analysis/report_parts.hpp"
#include "protocols/threshold/analysis/tables.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis::threshold {
namespace {

using study::threshold::ThresholdOptions;

const ThresholdOptions& options_of(const Outcomes& outcomes) {
  return study::threshold::options_of(outcomes.design);
}

/// The rows of tracks.csv that belong to a track.
DataTable model_table(const Outcomes& outcomes) {
  DataTable table = track_trials_table(outcomes);
  const auto kind = std::ranges::find(table.columns, "kind") - table.columns.begin();
  std::erase_if(table.rows, [&](const std::vector<DataCell>& row) {
    return row[static_cast<std::size_t>(kind)] != DataCell(std::string("track"));
  });
  return table;
}

std::string notes_on_model(const Outcomes& outcomes) {
  const ThresholdOptions& options = options_of(outcomes);
  const double share = procedures::share_at_threshold(options.track.grid.shape);
  return fmt::format(
      "# Threshold model of {}\n\n{}`threshold_model.csv` has one row for each answered trial of a "
      "track, in sessions that count. `Rscript threshold_model.R` fits one model to all of them "
      "with lme4 and prints the thresholds; with `--csv`, all their digits.\n\nThe model: "
      "P(right) = g + (1 - g - l) Phi(a + b x), with the guess rate g = {:.4g} and the lapse rate "
      "l = {:.4g} (the mean of the study's grid), an intercept and a slope for each standard, and "
      "random intercepts and slopes of participants (Moscatelli, Mezzetti, Lacquaniti 2012, "
      "Journal of Vision 12(11):26). x is the level, centred and scaled. If it is singular or does "
      "not converge, the same without their correlation, then with random intercepts alone; the "
      "script says which. A "
      "threshold is the level with {:.1f} % right, as in the report; its interval is by the delta "
      "method.\n\nAll participants have one lapse rate. The model takes the levels as given, "
      "although an adaptive procedure "
      "chose them by the answers. The report's thresholds are the ones to quote; this model shows "
      "whether they depend on fitting each track alone.\n\nColumns: `level_db` ({}), `comparison` "
      "(the quantity of the comparison), `target` and `response` (of the choices), `correct`.\n",
      one_line(outcomes.study),
      outcomes.simulated ? "SIMULATED: every participant is a program.\n\n" : "",
      options.track.grid.guess, mean_of(options.track.grid.lapses),
      100.0 * (options.track.grid.guess + (1.0 - options.track.grid.guess) * share),
      study::threshold::unit_of_level(options));
}

}  // namespace

std::string threshold_model_script(const Outcomes& outcomes) {
  const ThresholdOptions& options = options_of(outcomes);
  const std::vector<double>& levels = options.track.levels;
  const double range = std::max(levels.back() - levels.front(), 1.0);
  const procedures::ParameterGrid& grid = options.track.grid;
  return fmt::format(
             "# Threshold model of the study {}{}. Run: Rscript threshold_model.R\n"
             "# Needs lme4; reads threshold_model.csv beside this file. What it means: "
             "threshold_model.md.\nguess <- {:.17g}\nlapse <- {:.17g}\nshare_at_threshold <- "
             "{:.17g}\n"
             "centre_db <- {:.17g}\nscale_db <- {:.17g}\n\n",
             one_line(outcomes.study), outcomes.simulated ? " (SIMULATED)" : "", grid.guess,
             mean_of(grid.lapses), procedures::share_at_threshold(grid.shape),
             0.5 * (levels.front() + levels.back()), range / 8.0) +
         std::string(threshold_model_functions());
}

std::vector<std::filesystem::path> export_threshold_model(const record::StudyStore& store,
                                                          const Outcomes& outcomes,
                                                          const std::filesystem::path& folder) {
  if (options_of(outcomes).question == study::threshold::Question::same_different) {
    throw UsageError(
        "\"same or different\" has no guess rate, and so no model of thresholds; the report and "
        "--format csv have its d'");
  }
  const record::StudyCommitment& commitment = store.commitment();
  return write_export(folder, {commitment.study, commitment.study_id, "r"},
                      {text_file("threshold_model.csv", csv_text(model_table(outcomes))),
                       text_file("threshold_model.R", threshold_model_script(outcomes)),
                       text_file("threshold_model.md", notes_on_model(outcomes))});
}

}  // namespace touchtrial::analysis::threshold
