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

constexpr int kFitDraws = 399;  ///< for the goodness of fit of a track

/// The tracks of one participant, without estimates.
/// \param standards  the options with the levels of each standard
std::vector<TrackReport> tracks_of(const Person& person,
                                   std::span<const ThresholdOptions> standards) {
  if (standards.empty()) return {};
  const auto tracks_each = static_cast<std::size_t>(std::max(standards.front().tracks_each, 1));
  std::vector<TrackReport> tracks(standards.size() * tracks_each);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    tracks[i].participant = person.name;
    tracks[i].track = static_cast<int>(i) + 1;
    tracks[i].standard = i / tracks_each;
  }
  for (const TrialOutcome* trial : person.trials) {
    if (!is_track_trial(*trial) && !is_catch(*trial)) continue;
    const auto track = static_cast<std::size_t>(trial->chosen->track - 1);
    const auto level = static_cast<std::size_t>(trial->chosen->level);
    if (track >= tracks.size()) continue;
    if (level >= standards[track / tracks_each].track.levels.size()) continue;
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

/// Counts of answers, including catch trials.
std::vector<LevelCounts> all_counts(const TrackReport& track, std::span<const double> levels) {
  std::vector<TrackTrial> trials = track.trials;
  for (int i = 0; i < track.catches.n; ++i) {
    trials.push_back({levels.size() - 1, i < track.catches.correct});
  }
  return procedures::counts_of(levels, trials);
}

/// The information of a trial about a change of the threshold; p is the share right at its level.
struct TrialWeight {
  double score = 0.0;        ///< p' / (p (1 - p)), the weight of the residual
  double information = 0.0;  ///< p'^2 / (p (1 - p))
};

TrialWeight weight_at(Observer observer, double level) {
  constexpr double kStep_db = 0.01;
  // Without lapses, one mistake far above the threshold would dominate.
  observer.lapse = std::max(observer.lapse, 0.02);
  const procedures::AnswerShares shares = procedures::shares_at(observer, level);
  const double slope = (procedures::shares_at(observer, level + kStep_db).correct -
                        procedures::shares_at(observer, level - kStep_db).correct) /
                       (2.0 * kStep_db);
  const double variance = shares.correct * shares.wrong;
  return {slope / variance, slope * slope / variance};
}

/// The change of the threshold over a track, by one step of Fisher scoring from the fit without a
/// change. Each residual has mean 0 given the earlier answers, so an adaptive procedure does not
/// appear as learning.
/// \return nothing if the standard error exceeds a quarter of the range of levels
std::optional<double> learning_of(std::span<const TrackTrial> trials, const Observer& observer,
                                  std::span<const double> levels) {
  const double last_index = std::max(static_cast<double>(trials.size()) - 1.0, 1.0);
  std::vector<TrialWeight> weights;
  double information = 0.0;
  double mean_place = 0.0;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    weights.push_back(weight_at(observer, levels[trials[i].level]));
    information += weights[i].information;
    mean_place += weights[i].information * static_cast<double>(i) / last_index;
  }
  if (!(information > 0.0)) return std::nullopt;
  mean_place /= information;
  double score = 0.0;
  double spread = 0.0;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const double expected = procedures::shares_at(observer, levels[trials[i].level]).correct;
    const double place = static_cast<double>(i) / last_index - mean_place;
    score += place * weights[i].score * ((trials[i].correct ? 1.0 : 0.0) - expected);
    spread += place * place * weights[i].information;
  }
  const double max_error = 0.25 * (levels.back() - levels.front());
  if (!(spread * max_error * max_error >= 1.0)) return std::nullopt;
  return -score / spread;
}

/// \param index  selects the random stream
void estimate(TrackReport& track, const ThresholdOptions& options, std::size_t index) {
  const std::vector<double>& levels = options.track.levels;
  const procedures::ParameterGrid& grid = options.track.grid;
  const std::vector<LevelCounts> counts = all_counts(track, levels);
  track.estimate = procedures::estimate_threshold(counts, levels, grid.shape, grid.guess);
  if (options.track.procedure == "constant-stimuli" && counts.size() >= 2) {
    RandomStream random(1, "threshold analysis: goodness of fit", index);
    track.fit = procedures::goodness_of_fit(counts, {.shape = grid.shape, .guess = grid.guess},
                                            kFitDraws, random);
  }
  if (options.track.procedure.ends_with("up-down")) {
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
  for (const study::threshold::Standard& standard : study::threshold::standards_of(study)) {
    standards.push_back(options);
    standards.back().track.levels = study::threshold::levels_of(options, standard);
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
  return options.along == study::threshold::LevelQuantity::order ? fraction * standard.value
                                                                 : fraction;
}

Quantity quantity_of(const ThresholdOptions& options, const study::threshold::Standard& standard,
                     const procedures::Threshold& threshold) {
  return {quantity_at(options, standard, threshold.level),
          quantity_at(options, standard, threshold.low),
          quantity_at(options, standard, threshold.high)};
}

}  // namespace touchtrial::analysis::threshold
