#include "analysis/planning/threshold_pool.hpp"

#include "core/errors.hpp"
#include "core/parallel.hpp"
#include "protocols/procedures/estimates.hpp"
#include "protocols/session/session_runner.hpp"
#include "protocols/simulation/population.hpp"
#include "protocols/simulation/trial_course.hpp"
#include "protocols/threshold/study/threshold.hpp"
#include "record/session_recorder.hpp"

#include <cstddef>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::planning {
namespace {

using procedures::Censored;
using procedures::Threshold;
using procedures::TrackTrial;
using study::threshold::ThresholdOptions;

/// The trials of each track.
using TracksOfPerson = std::vector<std::vector<TrackTrial>>;

/// An order that keeps what its tracks heard.
class NotedOrder final : public study::AdaptiveOrder {
 public:
  NotedOrder(std::unique_ptr<study::AdaptiveOrder> order, TracksOfPerson& tracks)
      : order_(std::move(order)), tracks_(tracks) {}

  void choose(study::Presentation& presentation) const override { order_->choose(presentation); }
  void answer(const study::Presentation& shown, int choice) override {
    order_->answer(shown, choice);
    if (!shown.chosen || shown.chosen->track < 1) return;
    tracks_[static_cast<std::size_t>(shown.chosen->track - 1)].push_back(
        {static_cast<std::size_t>(shown.chosen->level), choice == shown.chosen->target});
  }

 private:
  std::unique_ptr<study::AdaptiveOrder> order_;
  TracksOfPerson& tracks_;
};

study::Study with_trials(const study::Study& study, int trials) {
  auto options = std::make_shared<ThresholdOptions>(study::threshold::options_of(study));
  options->track.trials = trials;
  options->control_trials = 0;
  study::Study changed = study;
  changed.options = options;
  try {
    static_cast<void>(procedures::Block(study::threshold::block_settings(changed), Digest{}));
  } catch (const std::invalid_argument& error) {
    throw UsageError(
        fmt::format("--trials: {} are impossible for this study: {}; give another number", trials,
                    error.what()));
  }
  return changed;
}

/// What the sessions of a pool share.
struct PoolSetting {
  const study::StudyKey& key;
  const session::StimulusSource& source;
  const simulation::SubjectModel& subject;
  const simulation::Population& population;
};

/// \return whether the session reached its end
bool hold_session(const PoolSetting& setting, int number, int visit,
                  simulation::SimulatedParticipant& participant, TracksOfPerson& tracks) {
  const study::StudyKey& key = setting.key;
  const study::ScheduleDraw draw = key.draw_of(number, study::Draws::rehearsal, visit);
  const study::Schedule schedule = study::make_schedule(key.study, draw);
  record::BufferedEvents unread;
  session::Session session(
      schedule, key.study.trials, record::SessionRecorder(number, SecretKey{}, unread), {},
      std::make_unique<NotedOrder>(study::adaptive_order(key.study, draw), tracks));
  record::SessionOpening opening;
  opening.participant = fmt::format("P{:03}", number);
  opening.enrolment = number;
  opening.visit = visit;
  opening.study_id = key.study_id;
  opening.seal = key.seal;
  opening.device = simulation::recorded_device(setting.subject);
  opening.simulated = true;
  session.open({}, opening, study::schedule_to_json(schedule, key));
  participant.come_to(visit, simulation::course_of(key.study, schedule));
  static_cast<void>(
      session::run_session_in_virtual_time(session, key, setting.source, participant));
  return session.presentations_left() == 0;
}

/// \return nothing if a session ended early
std::optional<TracksOfPerson> tracks_of_person(const PoolSetting& setting, int number) {
  const study::Study& study = setting.key.study;
  TracksOfPerson tracks(study::threshold::block_settings(study).tracks.size());
  const auto participant = setting.population.participant(number);
  for (int visit = 1; visit <= study.visits.count; ++visit) {
    if (!hold_session(setting, number, visit, *participant, tracks)) return std::nullopt;
  }
  return tracks;
}

Threshold threshold_of(const std::vector<TrackTrial>& trials,
                       const procedures::TrackSettings& track) {
  if (track.procedure == "constant-stimuli") {
    return procedures::likelihood_threshold(procedures::counts_of(track.levels, trials),
                                            {.shape = track.grid.shape, .guess = track.grid.guess});
  }
  return procedures::posterior_threshold(procedures::posterior_of(track.levels, track.grid, trials),
                                         track.levels);
}

std::vector<Threshold> thresholds_of(const TracksOfPerson& tracks,
                                     const procedures::TrackSettings& settings) {
  std::vector<Threshold> thresholds;
  for (const std::vector<TrackTrial>& trials : tracks) {
    thresholds.push_back(threshold_of(trials, settings));
  }
  return thresholds;
}

/// Adds a participant.
void add_person(ThresholdPool& pool, const std::vector<Threshold>& thresholds,
                std::size_t tracks_each) {
  std::vector<std::optional<double>>& person = pool.people.emplace_back(pool.standards.size());
  for (std::size_t standard = 0; standard < person.size(); ++standard) {
    double sum = 0.0;
    int n = 0;
    for (std::size_t i = 0; i < tracks_each; ++i) {
      const Threshold& threshold = thresholds[standard * tracks_each + i];
      ++pool.tracks;
      pool.censored_below += threshold.censored == Censored::below ? 1 : 0;
      pool.censored_above += threshold.censored == Censored::above ? 1 : 0;
      if (!threshold.level) continue;
      sum += *threshold.level;
      ++n;
    }
    if (n > 0) person[standard] = sum / n;
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
                              ": asks for same or different, which gives a d' at each level and no "
                              "threshold; power needs another question"));
  }
  study::StudyKey changed = key;
  changed.study = with_trials(key.study, trials);
  const std::unique_ptr<const simulation::Population> population =
      simulation::population_of({changed, source, subject, options.seed, options.jobs});
  const PoolSetting setting{changed, source, subject, *population};
  std::vector<std::optional<std::vector<Threshold>>> found(
      static_cast<std::size_t>(options.people));
  std::mutex counting;
  int done = 0;
  in_parallel(options.jobs, found.size(), [&](std::size_t i) {
    const auto tracks = tracks_of_person(setting, static_cast<int>(i) + 1);
    const auto& track = study::threshold::options_of(changed.study).track;
    if (tracks) found[i] = thresholds_of(*tracks, track);
    const std::lock_guard lock(counting);
    if (progress) progress(++done, options.people);
  });
  ThresholdPool pool{.trials = trials, .standards = {}, .people = {}};
  for (const auto& standard : study::threshold::standards_of(key.study)) {
    pool.standards.push_back(study::threshold::words_of(key.study, standard));
  }
  for (const auto& thresholds : found) {
    if (thresholds) {
      add_person(pool, *thresholds, static_cast<std::size_t>(registered.tracks_each));
    } else {
      ++pool.unfinished;
    }
  }
  return pool;
}

}  // namespace touchtrial::planning
