#include "protocols/threshold/analysis/exports.hpp"

#include "analysis/exports/data_table.hpp"
#include "analysis/exports/export_folder.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "core/errors.hpp"
#include "protocols/threshold/analysis/report.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis::threshold {
namespace {

using procedures::Censored;
using Row = std::vector<DataCell>;

DataCell side_cell(Censored side) {
  if (side == Censored::no) return std::monostate{};
  return std::string(side == Censored::below ? "below" : "above");
}

void add_threshold(Row& row, const procedures::Threshold& threshold) {
  row.push_back(or_nothing(threshold.level));
  row.push_back(or_nothing(threshold.low));
  row.push_back(or_nothing(threshold.high));
  row.push_back(side_cell(threshold.censored));
}

void add_estimate(Row& row, const std::optional<TrackEstimate>& estimate) {
  add_threshold(row, estimate ? estimate->threshold : procedures::Threshold{});
  row.push_back(or_nothing(estimate ? estimate->slope : std::nullopt));
  row.push_back(or_nothing(estimate ? estimate->lapse : std::nullopt));
}

Row threshold_row(const ThresholdReport& report, const TrackReport& track) {
  const StandardReport& standard = report.standards[track.standard];
  const auto label = static_cast<std::size_t>(standard.of.class_index);
  const TrackEstimate quoted = report.quoted(track).value_or(TrackEstimate{});
  const Quantity weber = quantity_of(report.options(), standard.of, quoted.threshold);
  Row row{track.participant,
          std::int64_t{track.track},
          label < report.classes.size() ? DataCell(report.classes[label]) : DataCell{},
          standard.of.value,
          std::int64_t{track.answers.n},
          std::int64_t{track.answers.correct}};
  add_estimate(row, track.posterior);
  add_estimate(row, track.likelihood);
  row.push_back(or_nothing(track.reversals ? track.reversals->level : std::nullopt));
  row.push_back(side_cell(track.reversals ? track.reversals->censored : Censored::no));
  row.push_back(or_nothing(weber.value));
  row.push_back(or_nothing(weber.low));
  row.push_back(or_nothing(weber.high));
  row.push_back(or_nothing(track.fit ? std::optional(track.fit->p) : std::nullopt));
  row.push_back(or_nothing(track.learning_db));
  row.push_back(or_nothing(report.criterion));
  return row;
}

std::string kind_word(const TrialOutcome& trial) {
  if (in_control(trial)) return "control";
  return trial.role == study::Role::catch_trial ? "catch" : "track";
}

/// A trial's choice; empty if it is none of the study's.
DataCell choice_cell(const Outcomes& outcomes, const std::optional<int>& choice) {
  if (!choice || *choice < 0 || static_cast<std::size_t>(*choice) >= outcomes.choices.size()) {
    return std::monostate{};
  }
  return outcomes.choices[static_cast<std::size_t>(*choice)];
}

/// What a track is about; nothing for trials of none.
std::optional<study::threshold::Standard> standard_of(const Outcomes& outcomes,
                                                      const TrialOutcome& trial) {
  if (!in_track(trial)) return std::nullopt;
  const auto all = study::threshold::standards_of(outcomes.design);
  const int each = std::max(study::threshold::options_of(outcomes.design).tracks_each, 1);
  const auto place = static_cast<std::size_t>((trial.chosen->track - 1) / each);
  return place < all.size() ? std::optional(all[place]) : std::nullopt;
}

DataCell track_cell(const TrialOutcome& trial) {
  return in_track(trial) ? DataCell(std::int64_t{trial.chosen->track}) : DataCell{};
}

DataCell standard_cell(const Outcomes& outcomes, const TrialOutcome& trial) {
  const auto standard = standard_of(outcomes, trial);
  return standard ? DataCell(study::threshold::words_of(outcomes.design, *standard)) : DataCell{};
}

/// The level of a trial, if it has one of the study's.
std::optional<double> level_of(const Outcomes& outcomes, const TrialOutcome& trial) {
  const auto& levels = study::threshold::options_of(outcomes.design).track.levels;
  if (!trial.chosen || trial.chosen->level < 0) return std::nullopt;
  const auto level = static_cast<std::size_t>(trial.chosen->level);
  return level < levels.size() ? std::optional(levels[level]) : std::nullopt;
}

/// What the comparison of a trial was, in the units of the standard.
DataCell comparison_cell(const Outcomes& outcomes, const TrialOutcome& trial) {
  const auto standard = standard_of(outcomes, trial);
  const auto level = level_of(outcomes, trial);
  if (!standard || !level) return std::monostate{};
  const auto& options = study::threshold::options_of(outcomes.design);
  return study::threshold::comparison_at(options, *standard, *level);
}

Row trial_row(const Outcomes& outcomes, const choices::Person& person, const TrialOutcome& trial) {
  return {person.name,
          std::int64_t{trial.row.session},
          std::int64_t{trial.row.trial},
          track_cell(trial),
          standard_cell(outcomes, trial),
          or_nothing(level_of(outcomes, trial)),
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

std::vector<TrialColumn> threshold_trial_columns() {
  return {{"track", true, [](const TrialView& trial) { return track_cell(*trial.outcome); }},
          {"standard", true,
           [](const TrialView& trial) { return standard_cell(*trial.study, *trial.outcome); }},
          {"level_db", true, [](const TrialView& trial) {
             return or_nothing(level_of(*trial.study, *trial.outcome));
           }}};
}

DataTable thresholds_table(const ThresholdReport& report, bool simulated) {
  DataTable table{{"participant", "track", "class", "standard_value", "trials", "right"}, {}};
  for (const std::string estimate : {"posterior", "likelihood"}) {
    for (const char* of : {"_db", "_low_db", "_high_db", "_censored", "_slope", "_lapse"}) {
      table.columns.push_back(estimate + of);
    }
  }
  table.columns.insert(table.columns.end(),
                       {"reversals_db", "reversals_censored", "weber", "weber_low", "weber_high",
                        "fit_p", "learning_db", "criterion", "simulated"});
  for (const TrackReport& track : report.tracks) {
    table.rows.push_back(threshold_row(report, track));
    table.rows.back().push_back(flag(simulated));
  }
  return table;
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
