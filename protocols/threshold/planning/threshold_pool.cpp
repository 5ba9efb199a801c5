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

/// The trials of each track, including its catch trials.
using TracksOfPerson = std::vector<std::vector<TrackTrial>>;

study::Study with_trials(const study::Study& study, int trials) {
  ThresholdOptions options = study::threshold::options_of(study);
  options.track.trials = trials;
  options.control_trials = 0;
  study::Study changed = study::threshold::with_options(study, options);
  try {
    static_cast<void>(procedures::Block(study::threshold::block_settings(changed), Digest{}));
  } catch (const std::invalid_argument& error) {
    throw UsageError(fmt::format(
        "--trials: {} is impossible for this study: {}; use another number", trials, error.what()));
  }
  return changed;
}

/// \return empty if a session ended early
std::optional<TracksOfPerson> tracks_of_person(const PoolSetting& setting, int number) {
  TracksOfPerson tracks(study::threshold::block_settings(setting.key.study).tracks.size());
  const auto note = [&tracks](const study::Order& order, const study::Trial& shown,
                              const Answer& answer) {
    if (!shown.level || shown.level->track < 1) return;
    tracks[static_cast<std::size_t>(shown.level->track - 1)].push_back(
        {static_cast<std::size_t>(shown.level->level),
         order.schedule().choice_of(answer) == shown.right});
  };
  if (!run_pool_sessions(setting, number, note)) return std::nullopt;
  return tracks;
}

/// One person's thresholds, by standard.
std::vector<PersonThreshold> thresholds_of(const TracksOfPerson& tracks,
                                           const study::Study& study) {
  const std::vector<procedures::TrackSettings> settings =
      study::threshold::block_settings(study).tracks;
  const auto each = static_cast<std::size_t>(study::threshold::options_of(study).tracks_each);
  std::vector<PersonThreshold> thresholds;
  std::vector<ThresholdEstimate> own;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const std::vector<double>& levels = settings[i].levels;
    const procedures::ParameterGrid& grid = settings[i].grid;
    own.push_back(procedures::estimate_threshold(procedures::counts_of(levels, tracks[i]), levels,
                                                 grid.shape, grid.guess));
    if (own.size() < each) continue;
    thresholds.push_back(analysis::threshold::person_threshold(own, levels));
    own.clear();
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
  const ThresholdOptions& registered = study::threshold::options_of(key.study);
  if (registered.question == study::threshold::Question::same_different) {
    throw UsageError(one_line(key.study.source +
                              ": the question same-different gives a d' at each level but no "
                              "threshold; use a study with another question"));
  }
  study::StudyKey changed = key;
  changed.study = with_trials(key.study, trials);
  const std::unique_ptr<const simulation::Population> population =
      simulation::population_of({changed, source, subject, options.seed, options.jobs});
  const PoolSetting setting{changed, source, subject, *population};
  std::vector<std::optional<std::vector<PersonThreshold>>> found(
      static_cast<std::size_t>(options.people));
  std::mutex counting;
  int done = 0;
  in_parallel(options.jobs, found.size(), [&](std::size_t i) {
    const auto tracks = tracks_of_person(setting, static_cast<int>(i) + 1);
    if (tracks) found[i] = thresholds_of(*tracks, changed.study);
    const std::lock_guard lock(counting);
    if (progress) progress(++done, options.people);
  });
  ThresholdPool pool{.trials = trials, .standards = {}, .people = {}};
  for (const auto& standard : study::threshold::standards_of(key.study)) {
    pool.standards.push_back(study::threshold::words_of(key.study, standard));
  }
  for (const auto& thresholds : found) {
    if (thresholds) {
      add_person(pool, *thresholds, registered.tracks_each);
    } else {
      ++pool.unfinished;
    }
  }
  return pool;
}

}  // namespace touchtrial::planning::threshold
