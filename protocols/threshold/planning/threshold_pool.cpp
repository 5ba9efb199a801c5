#include "protocols/threshold/planning/threshold_pool.hpp"

#include "analysis/planning/pool_sessions.hpp"
#include "core/errors.hpp"
#include "core/parallel.hpp"
#include "protocols/procedures/estimates.hpp"
#include "protocols/simulation/population.hpp"
#include "protocols/threshold/analysis/person_threshold.hpp"
#include "protocols/threshold/study/threshold.hpp"

#include <cstddef>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::planning::threshold {
namespace {

using analysis::threshold::PersonThreshold;
using procedures::Censored;
using procedures::ThresholdEstimate;
using procedures::TrackTrial;
using study::threshold::ThresholdOptions;

/// The trials of each track, including catch trials.
using TracksOfPerson = std::vector<std::vector<TrackTrial>>;

study::Study with_trials_per_track(const study::Study& study, int trials) {
  ThresholdOptions options = study::threshold::options_of(study);
  options.track.trials = trials;
  options.control_trials = 0;
  study::Study changed_study = study::threshold::with_options(study, options);
  try {
    static_cast<void>(procedures::Block(study::threshold::block_settings(changed_study), Digest{}));
  } catch (const std::invalid_argument& error) {
    throw UsageError(fmt::format(
        "--trials: {} is impossible for this study: {}; use another number", trials, error.what()));
  }
  return changed_study;
}

/// \return empty if a session was not completed
std::optional<TracksOfPerson> tracks_of_person(const PoolSetting& setting, int number) {
  TracksOfPerson tracks(study::threshold::block_settings(setting.key.study).tracks.size());
  const auto add_trial = [&tracks](const study::Order& order, const study::Trial& presented,
                                   const Answer& answer) {
    if (!presented.level || presented.level->track < 1) return;
    tracks[static_cast<std::size_t>(presented.level->track - 1)].push_back(
        {static_cast<std::size_t>(presented.level->level),
         order.schedule().choice_of(answer) == presented.right});
  };
  if (!run_pool_sessions(setting, number, add_trial)) return std::nullopt;
  return tracks;
}

std::vector<PersonThreshold> thresholds_of(const TracksOfPerson& tracks,
                                           const study::Study& study) {
  const std::vector<procedures::TrackSettings> settings =
      study::threshold::block_settings(study).tracks;
  const auto tracks_each =
      static_cast<std::size_t>(study::threshold::options_of(study).tracks_each);
  std::vector<PersonThreshold> thresholds;
  std::vector<ThresholdEstimate> standard_estimates;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const std::vector<double>& levels = settings[i].levels;
    const procedures::ParameterGrid& grid = settings[i].grid;
    standard_estimates.push_back(procedures::estimate_threshold(
        procedures::counts_of(levels, tracks[i]), levels, grid.shape, grid.guess));
    if (standard_estimates.size() < tracks_each) continue;
    thresholds.push_back(analysis::threshold::person_threshold(standard_estimates, levels));
    standard_estimates.clear();
  }
  return thresholds;
}

void add_person(ThresholdPool& pool, const std::vector<PersonThreshold>& thresholds,
                int tracks_each) {
  pool.tracks += static_cast<int>(thresholds.size()) * tracks_each;
  pool.people.push_back(analysis::threshold::bounds_of(thresholds));
  for (const PersonThreshold& one : thresholds) {
    pool.below += one.censored == Censored::below ? 1 : 0;
    pool.above += one.censored == Censored::above ? 1 : 0;
    pool.undetermined += one.censored == Censored::undetermined ? 1 : 0;
  }
}

}  // namespace

ThresholdPool simulated_thresholds(const study::StudyKey& key,
                                   const session::StimulusSource& source,
                                   const simulation::SubjectModel& subject, int trials,
                                   const ThresholdPoolOptions& options,
                                   const study::Progress& progress) {
  const ThresholdOptions& study_options = study::threshold::options_of(key.study);
  if (study_options.question == study::threshold::Question::same_different) {
    throw UsageError(one_line(key.study.source +
                              ": the question same-different gives a d' at each level but no "
                              "threshold; use a study with another question"));
  }
  study::StudyKey changed_key = key;
  changed_key.study = with_trials_per_track(key.study, trials);
  const std::unique_ptr<const simulation::Population> population =
      simulation::population_of({changed_key, source, subject, options.seed, options.jobs});
  const PoolSetting setting{changed_key, source, subject, *population};
  std::vector<std::optional<std::vector<PersonThreshold>>> all_thresholds(
      static_cast<std::size_t>(options.people));
  std::mutex progress_mutex;
  int finished = 0;
  in_parallel(options.jobs, all_thresholds.size(), [&](std::size_t i) {
    const auto tracks = tracks_of_person(setting, static_cast<int>(i) + 1);
    if (tracks) all_thresholds[i] = thresholds_of(*tracks, changed_key.study);
    const std::lock_guard lock(progress_mutex);
    if (progress) progress(++finished, options.people);
  });
  ThresholdPool pool{.trials = trials, .standards = {}, .people = {}};
  for (const auto& standard : study::threshold::standards_of(key.study)) {
    pool.standards.push_back(study::threshold::words_of(key.study, standard));
  }
  for (const auto& thresholds : all_thresholds) {
    if (thresholds) {
      add_person(pool, *thresholds, study_options.tracks_each);
    } else {
      ++pool.unfinished;
    }
  }
  return pool;
}

}  // namespace touchtrial::planning::threshold
