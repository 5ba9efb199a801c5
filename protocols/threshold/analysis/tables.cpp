#include "protocols/threshold/analysis/tables.hpp"

#include "protocols/threshold/analysis/report_parts.hpp"

#include <algorithm>

namespace touchtrial::analysis::threshold {
namespace {

using procedures::Censored;
using Row = std::vector<DataCell>;

DataCell number_cell(const std::optional<double>& number) {
  if (!number) return std::monostate{};
  return *number;
}

DataCell side_cell(Censored side) {
  if (side == Censored::no) return std::monostate{};
  return std::string(side == Censored::below ? "below" : "above");
}

void add_threshold(Row& row, const procedures::Threshold& threshold) {
  row.push_back(number_cell(threshold.level));
  row.push_back(number_cell(threshold.low));
  row.push_back(number_cell(threshold.high));
  row.push_back(side_cell(threshold.censored));
}

void add_estimate(Row& row, const std::optional<TrackEstimate>& estimate) {
  add_threshold(row, estimate ? estimate->threshold : procedures::Threshold{});
  row.push_back(number_cell(estimate ? estimate->slope : std::nullopt));
  row.push_back(number_cell(estimate ? estimate->lapse : std::nullopt));
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
  row.push_back(number_cell(track.reversals ? track.reversals->level : std::nullopt));
  row.push_back(side_cell(track.reversals ? track.reversals->censored : Censored::no));
  row.push_back(number_cell(weber.value));
  row.push_back(number_cell(weber.low));
  row.push_back(number_cell(weber.high));
  row.push_back(number_cell(track.fit ? std::optional(track.fit->p) : std::nullopt));
  row.push_back(number_cell(track.learning_db));
  row.push_back(number_cell(report.criterion));
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

Row trial_row(const Outcomes& outcomes, const Person& person, const TrialOutcome& trial) {
  return {person.name,
          std::int64_t{trial.row.session},
          std::int64_t{trial.row.trial},
          track_cell(trial),
          standard_cell(outcomes, trial),
          number_cell(level_of(outcomes, trial)),
          comparison_cell(outcomes, trial),
          choice_cell(outcomes, trial.right),
          choice_cell(outcomes, trial.response),
          flag(trial.correct()),
          kind_word(trial),
          flag(outcomes.simulated)};
}

}  // namespace

std::vector<TrialColumn> threshold_trial_columns() {
  return {{"track", true, [](const TrialView& trial) { return track_cell(*trial.outcome); }},
          {"standard", true,
           [](const TrialView& trial) { return standard_cell(*trial.study, *trial.outcome); }},
          {"level_db", true, [](const TrialView& trial) {
             return number_cell(level_of(*trial.study, *trial.outcome));
           }}};
}

DataTable thresholds_table(const ThresholdReport& report, bool simulated) {
  DataTable table{{"participant",
                   "track",
                   "class",
                   "standard_value",
                   "trials",
                   "right",
                   "posterior_db",
                   "posterior_low_db",
                   "posterior_high_db",
                   "posterior_censored",
                   "posterior_slope",
                   "posterior_lapse",
                   "likelihood_db",
                   "likelihood_low_db",
                   "likelihood_high_db",
                   "likelihood_censored",
                   "likelihood_slope",
                   "likelihood_lapse",
                   "reversals_db",
                   "reversals_censored",
                   "weber",
                   "weber_low",
                   "weber_high",
                   "fit_p",
                   "learning_db",
                   "criterion",
                   "simulated"},
                  {}};
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
  for (const Person& person : people_of(outcomes)) {
    for (const TrialOutcome* trial : person.trials) {
      table.rows.push_back(trial_row(outcomes, person, *trial));
    }
  }
  return table;
}

}  // namespace touchtrial::analysis::threshold
