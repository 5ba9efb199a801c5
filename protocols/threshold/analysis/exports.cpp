#include "protocols/threshold/analysis/exports.hpp"

#include "core/errors.hpp"
#include "protocols/threshold/analysis/report.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis::threshold {
namespace {

std::string kind_word(const TrialOutcome& trial) {
  if (is_control_trial(trial)) return "control";
  return trial.role == study::Role::catch_trial ? "catch" : "track";
}

/// The label of a choice; empty if the choice is not one of the study's.
DataCell choice_cell(const Outcomes& outcomes, const std::optional<int>& choice) {
  if (!choice || *choice < 0 || static_cast<std::size_t>(*choice) >= outcomes.choices.size()) {
    return std::monostate{};
  }
  return outcomes.choices[static_cast<std::size_t>(*choice)];
}

/// The standard of a trial; nothing for trials without a track.
std::optional<study::threshold::Standard> standard_of(const Outcomes& outcomes,
                                                      const TrialOutcome& trial) {
  if (!trial.chosen || trial.chosen->track < 1) return std::nullopt;
  const auto standards = study::threshold::standards_of(outcomes.design);
  const int tracks_each = std::max(study::threshold::options_of(outcomes.design).tracks_each, 1);
  const auto index = static_cast<std::size_t>((trial.chosen->track - 1) / tracks_each);
  return index < standards.size() ? std::optional(standards[index]) : std::nullopt;
}

DataCell track_cell(const TrialOutcome& trial) {
  const bool has_track = trial.chosen && trial.chosen->track > 0;
  return has_track ? DataCell(std::int64_t{trial.chosen->track}) : DataCell{};
}

DataCell standard_cell(const Outcomes& outcomes, const TrialOutcome& trial) {
  const auto standard = standard_of(outcomes, trial);
  return standard ? DataCell(study::threshold::words_of(outcomes.design, *standard)) : DataCell{};
}

/// The level of a trial; nothing if it is not one of the study's.
std::optional<double> level_of(const Outcomes& outcomes, const TrialOutcome& trial) {
  const auto& levels = study::threshold::options_of(outcomes.design).track.levels;
  if (!trial.chosen || trial.chosen->level < 0) return std::nullopt;
  const auto level = static_cast<std::size_t>(trial.chosen->level);
  return level < levels.size() ? std::optional(levels[level]) : std::nullopt;
}

/// The quantity of the comparison, in the units of the standard.
DataCell comparison_cell(const Outcomes& outcomes, const TrialOutcome& trial) {
  const auto standard = standard_of(outcomes, trial);
  const auto level = level_of(outcomes, trial);
  if (!standard || !level) return std::monostate{};
  const auto& options = study::threshold::options_of(outcomes.design);
  return study::threshold::comparison_at(options, *standard, *level);
}

std::vector<DataCell> trial_row(const Outcomes& outcomes, const choices::Person& person,
                                const TrialOutcome& trial) {
  return {person.name,
          std::int64_t{trial.row.session},
          std::int64_t{trial.row.trial},
          track_cell(trial),
          standard_cell(outcomes, trial),
          optional_cell(level_of(outcomes, trial)),
          comparison_cell(outcomes, trial),
          choice_cell(outcomes, trial.right),
          choice_cell(outcomes, trial.response),
          flag(trial.correct()),
          kind_word(trial),
          flag(outcomes.simulated)};
}

using study::threshold::ThresholdOptions;

const ThresholdOptions& options_of(const Outcomes& outcomes) {
  return study::threshold::options_of(outcomes.design);
}

/// The rows of tracks.csv with a track, including catch trials.
DataTable model_table(const Outcomes& outcomes) {
  DataTable table = track_trials_table(outcomes);
  const auto track = std::ranges::find(table.columns, "track") - table.columns.begin();
  std::erase_if(table.rows, [&](const std::vector<DataCell>& row) {
    return std::holds_alternative<std::monostate>(row[static_cast<std::size_t>(track)]);
  });
  return table;
}

std::string model_notes(const Outcomes& outcomes) {
  const ThresholdOptions& options = options_of(outcomes);
  const double share = procedures::share_at_threshold(options.track.grid.shape);
  return fmt::format(
      "`threshold_model.csv` has one row per answered trial of a track, including catch trials, in "
      "counted sessions. `Rscript threshold_model.R` fits one model to all of them with lme4 and "
      "prints thresholds and their differences; with `--csv`, all digits.\n\nThe model "
      "(Moscatelli, Mezzetti, Lacquaniti 2012, Journal of Vision 12(11):26): P(right) = g + (1 - g "
      "- l) F(a + b x), with the study's function F ({}), the guess rate g = {:.4g} and an "
      "intercept and a slope for each standard; x is the level, centred by standard and scaled. "
      "Intercepts and slopes differ between participants and, with several standards, also between "
      "a participant's standards:\n\n    (1 + x | participant) + (1 + x | "
      "participant:standard)\n\nIf the trials do not determine this model (singular, or not "
      "converged), the same without correlations, then without slopes that differ between a "
      "participant's standards, then with intercepts only; never without participants' standards. "
      "The script prints what it fitted.\n\nThe lapse rate l is the same for all participants: the "
      "maximum of the likelihood, with a separate intercept for every participant and standard, "
      "times the density Beta(1, 10). It is determined mostly by catch trials, at the highest "
      "level.\n\nA threshold is the level with {:.1f}% right without lapses, as in the report. "
      "Intervals are by the delta method, with as many degrees of freedom as participants, minus "
      "one. Their coverage: docs/procedures-recovery.md. The model treats the levels as given, "
      "although an adaptive procedure chose them from the answers. Quote the report's thresholds; "
      "this model shows whether they depend on separate fits to tracks.\n\nColumns: `level_db` "
      "({}), `comparison` (the quantity of the comparison), `target` and `response` (choices), "
      "`correct`, `kind` (`track`, or `catch`: not used by the procedure).\n",
      study::threshold::name_of(options.track.grid.shape), options.track.grid.guess,
      100.0 * (options.track.grid.guess + (1.0 - options.track.grid.guess) * share),
      study::threshold::unit_of_level(options));
}

}  // namespace

std::vector<TrialColumn> threshold_trial_columns() {
  return {{"track", true, [](const TrialView& trial) { return track_cell(*trial.outcome); }},
          {"standard", true,
           [](const TrialView& trial) { return standard_cell(*trial.study, *trial.outcome); }},
          {"level_db", true, [](const TrialView& trial) {
             return optional_cell(level_of(*trial.study, *trial.outcome));
           }}};
}

DataTable track_trials_table(const Outcomes& outcomes) {
  DataTable table{{"participant", "session", "trial", "track", "standard", "level_db", "comparison",
                   "target", "response", "correct", "kind", "simulated"},
                  {}};
  for (const choices::Person& person : people_of(outcomes)) {
    for (const TrialOutcome* trial : person.trials) {
      table.rows.push_back(trial_row(outcomes, person, *trial));
    }
  }
  return table;
}

RModel threshold_model(const Outcomes& outcomes) {
  const ThresholdOptions& options = options_of(outcomes);
  if (options.question == study::threshold::Question::same_different) {
    throw UsageError(
        "\"same or different\" has no guess rate, and so no model of thresholds; the report and "
        "--format csv contain its d'");
  }
  const std::vector<double>& levels = options.track.levels;
  const double range = std::max(levels.back() - levels.front(), 1.0);
  const procedures::ParameterGrid& grid = options.track.grid;
  return {"Threshold model", "threshold_model", model_table(outcomes),
          fmt::format("shape <- \"{}\"\nguess <- {:.17g}\nscale_db <- {:.17g}\n\n{}",
                      study::threshold::name_of(grid.shape), grid.guess, range / 8.0,
                      threshold_model_functions()),
          model_notes(outcomes)};
}

}  // namespace touchtrial::analysis::threshold
