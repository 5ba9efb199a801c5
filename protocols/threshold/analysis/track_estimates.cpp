#include "core/named.hpp"
#include "core/parallel.hpp"
#include "protocols/threshold/analysis/report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace touchtrial::analysis::threshold {
namespace {

using choices::Person;
using procedures::LevelCounts;
using procedures::Observer;
using procedures::TrackTrial;
using study::threshold::ThresholdOptions;

/// Draws of one track's goodness of fit.
constexpr int kFitDraws = 399;

/// The trials of every track of one participant.
/// \param standards  the study with the levels of each standard
std::vector<TrackReport> tracks_of(const Person& person,
                                   std::span<const ThresholdOptions> standards) {
  if (standards.empty()) return {};
  const auto each = static_cast<std::size_t>(std::max(standards.front().tracks_each, 1));
  std::vector<TrackReport> tracks(standards.size() * each);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    tracks[i].participant = person.name;
    tracks[i].track = static_cast<int>(i) + 1;
    tracks[i].standard = i / each;
  }
  for (const TrialOutcome* trial : person.trials) {
    if (!in_track(*trial) && !is_catch(*trial)) continue;
    const auto track = static_cast<std::size_t>(trial->chosen->track - 1);
    const auto level = static_cast<std::size_t>(trial->chosen->level);
    if (track >= tracks.size()) continue;
    if (level >= standards[track / each].track.levels.size()) continue;
    if (is_catch(*trial)) {
      tracks[track].catches.add(trial->correct());
    } else {
      tracks[track].trials.push_back({level, trial->correct()});
      tracks[track].answers.add(trial->correct());
    }
  }
  std::erase_if(tracks, [](const TrackReport& track) { return track.trials.empty(); });
  return tracks;
}

bool is_constant(const ThresholdOptions& options) {
  return options.track.procedure == "constant-stimuli";
}

bool is_staircase(const ThresholdOptions& options) {
  return options.track.procedure.ends_with("up-down");
}

procedures::FitOptions fit_options(const ThresholdOptions& options) {
  return {.shape = options.track.grid.shape, .guess = options.track.grid.guess};
}

/// Counts of the procedure's trials and of the catch trials.
std::vector<LevelCounts> counts_of_both(const TrackReport& track, std::span<const double> levels) {
  std::vector<TrackTrial> trials = track.trials;
  for (int i = 0; i < track.catches.n; ++i) {
    trials.push_back({levels.size() - 1, i < track.catches.correct});
  }
  return procedures::counts_of(levels, trials);
}

/// One trial's information about a change of the threshold, with p the share right at its level.
struct TrialWeight {
  double score = 0.0;        ///< p' / (p (1 - p)), by which a residual counts
  double information = 0.0;  ///< p'^2 / (p (1 - p))
};

TrialWeight weight_at(Observer observer, double level) {
  constexpr double kStep_db = 0.01;
  // Without lapses, one mistake far above the threshold would outweigh everything else.
  observer.lapse = std::max(observer.lapse, 0.02);
  const procedures::AnswerShares at = procedures::shares_at(observer, level);
  const double rise = (procedures::shares_at(observer, level + kStep_db).correct -
                       procedures::shares_at(observer, level - kStep_db).correct) /
                      (2.0 * kStep_db);
  const double variance = at.correct * at.wrong;
  return {rise / variance, rise * rise / variance};
}

/// The change of the threshold over a track, by one step of Fisher scoring from the fit without a
/// change. Each residual has mean 0 given the earlier answers, so an adaptive procedure does not
/// look like learning.
/// \return nothing if its standard error is more than a quarter of the range of levels
std::optional<double> learning_of(std::span<const TrackTrial> trials, const Observer& observer,
                                  std::span<const double> levels) {
  const double last = std::max(static_cast<double>(trials.size()) - 1.0, 1.0);
  std::vector<TrialWeight> weights;
  double information = 0.0;
  double middle = 0.0;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    weights.push_back(weight_at(observer, levels[trials[i].level]));
    information += weights[i].information;
    middle += weights[i].information * static_cast<double>(i) / last;
  }
  if (!(information > 0.0)) return std::nullopt;
  middle /= information;
  double score = 0.0;
  double spread = 0.0;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const double expected = procedures::shares_at(observer, levels[trials[i].level]).correct;
    const double place = static_cast<double>(i) / last - middle;
    score += place * weights[i].score * ((trials[i].correct ? 1.0 : 0.0) - expected);
    spread += place * place * weights[i].information;
  }
  const double max_error = 0.25 * (levels.back() - levels.front());
  if (!(spread * max_error * max_error >= 1.0)) return std::nullopt;
  return -score / spread;
}

/// \param index  chooses the stream of random numbers
void estimate(TrackReport& track, const ThresholdOptions& options, std::size_t index) {
  const std::vector<double>& levels = options.track.levels;
  const procedures::ParameterGrid& assumed = options.track.grid;
  const std::vector<LevelCounts> counts = counts_of_both(track, levels);
  track.estimate = procedures::estimate_threshold(counts, levels, assumed.shape, assumed.guess);
  if (is_constant(options) && counts.size() >= 2) {
    RandomStream random(1, "threshold analysis: goodness of fit", index);
    track.fit = procedures::goodness_of_fit(counts, fit_options(options), kFitDraws, random);
  }
  if (is_staircase(options)) {
    track.reversals = procedures::reversal_threshold(levels, track.trials);
  }
  if (track.threshold()) {
    track.learning_db = learning_of(track.trials, track.estimate->observer, levels);
  }
}

}  // namespace

std::vector<TrackReport> track_reports(const study::Study& study, std::span<const Person> people,
                                       int jobs) {
  const ThresholdOptions& options = study::threshold::options_of(study);
  std::vector<ThresholdOptions> standards;
  for (const study::threshold::Standard& of : study::threshold::standards_of(study)) {
    standards.push_back(options);
    standards.back().track.levels = study::threshold::levels_of(options, of);
  }
  std::vector<TrackReport> all;
  for (const Person& person : people) {
    for (TrackReport& track : tracks_of(person, standards)) {
      all.push_back(std::move(track));
    }
  }
  if (options.question == study::threshold::Question::same_different) return all;
  in_parallel(jobs, all.size(),
              [&](std::size_t i) { estimate(all[i], standards[all[i].standard], i); });
  return all;
}

std::string_view word_of(procedures::Censored censored) {
  using enum procedures::Censored;
  static constexpr auto kWords = std::to_array<Named<procedures::Censored>>(
      {{"", no}, {"below", below}, {"above", above}, {"undetermined", undetermined}});
  return name_in(kWords, censored);
}

std::optional<double> quantity_at(const ThresholdOptions& options,
                                  const study::threshold::Standard& standard,
                                  const std::optional<double>& level) {
  if (!level || options.task == study::threshold::Task::detection) return std::nullopt;
  const double fraction = procedures::weber_fraction(*level);
  return options.along == study::threshold::Along::order ? fraction * standard.value : fraction;
}

Quantity quantity_of(const ThresholdOptions& options, const study::threshold::Standard& standard,
                     const procedures::Threshold& threshold) {
  return {quantity_at(options, standard, threshold.level),
          quantity_at(options, standard, threshold.low),
          quantity_at(options, standard, threshold.high)};
}

}  // namespace touchtrial::analysis::threshold
