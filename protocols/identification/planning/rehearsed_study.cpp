#include "protocols/identification/planning/rehearsed_study.hpp"

#include "core/errors.hpp"
#include "core/random.hpp"
#include "protocols/identification/planning/rehearsal.hpp"
#include "protocols/simulation/condition.hpp"
#include "protocols/simulation/felt_decision.hpp"
#include "protocols/simulation/own_knowledge.hpp"
#include "protocols/simulation/simulated_participant.hpp"
#include "study/protocol.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::planning::identification {
namespace {

/// The seed of a training, which differs from the seeds of the studies that use it.
std::uint64_t training_seed(std::uint64_t seed, int training) {
  return RandomStream(seed, "power: training", static_cast<std::uint64_t>(training)).bits();
}

std::vector<study::StimulusIndex> stimuli_of_method(const study::Study& study, int method) {
  std::vector<study::StimulusIndex> stimuli;
  for (int c = 0; c < static_cast<int>(study.classes.size()); ++c) {
    for (int e = 0; e < static_cast<int>(study.classes[c].images.size()); ++e) {
      stimuli.push_back({c, e, method});
    }
  }
  return stimuli;
}

}  // namespace

void require_answers(const study::Study& study, const simulation::SubjectModel& subject) {
  const bool is_in_time = subject.explore_s < study.trials.explore_limit_s;
  if (is_in_time || study.trials.on_timeout != study::OnTimeout::no_response) return;
  throw StudyError(one_line(fmt::format(
      "{}: /explore_s: {} s is not less than the study's explore_limit_s ({} s), after which it "
      "rejects answers (on_timeout \"no-response\"), so nobody would ever answer; lower explore_s",
      subject.source, subject.explore_s, study.trials.explore_limit_s)));
}

PrecomputedPerception::PrecomputedPerception(const simulation::LabelledFields& fields,
                                             const study::Study& study,
                                             const simulation::SubjectModel& subject,
                                             const PrecomputedPerceptionOptions& options,
                                             const study::Progress& progress)
    : bank_(fields, study, subject, {options.explorations, options.seed, options.jobs}, progress) {
  for (int i = 0; i < options.trainings; ++i) {
    trainings_.push_back(
        simulation::learn(fields, study, subject, training_seed(options.seed, i), options.jobs));
  }
}

std::shared_ptr<const simulation::FeltKnowledge> PrecomputedPerception::knowledge(
    std::uint64_t study_seed) const {
  RandomStream random(study_seed, "power: which training");
  return trainings_[random.below(trainings_.size())];
}

engine::FeltFeatures PrecomputedPerception::felt(const study::StimulusIndex& stimulus,
                                                 const FeltTrial& trial) const {
  // With 64 random bits, the bias of the modulo is negligible.
  const auto explorations = static_cast<std::uint64_t>(bank_.explorations());
  return bank_.felt(bank_.place_of(stimulus))[trial.draw % explorations];
}

/// Data common to the participants of one simulated study.
struct RehearsedStudy::SharedInput {
  const simulation::SubjectModel& subject;
  const std::shared_ptr<const simulation::FeltKnowledge>& knowledge;
  Hypothesis hypothesis;
  std::uint64_t study_seed;
};

RehearsedStudy::RehearsedStudy(const study::Study& study, const simulation::SubjectModel& subject,
                               const PrimaryTest& test, const PerceptionSource& perception,
                               int max_participants)
    : subject_(subject),
      test_(test),
      perception_(perception),
      visits_(study.visits.count),
      first_method_stimuli_(stimuli_of_method(study, test.first)),
      empty_(empty_outcomes(study)) {
  require_answers(study, subject);
  const study::StudyKey key = study::simulated_study_key(study);
  for (int i = 0; i < max_participants * visits_; ++i) {
    schedules_.push_back(planned_visit(study, key, 1 + i / visits_, 1 + i % visits_));
  }
  if (test_.margin) set_margin();
}

void RehearsedStudy::set_margin() {
  constexpr int kPeople = 400;
  const double accuracy = accuracy_of(kPeople);
  if (accuracy <= *test_.margin) {
    throw UsageError(
        fmt::format("a margin of {:.4g} points is not less than the accuracy of equal methods "
                    "({:.1f} %), so no "
                    "method can be worse by it; choose a smaller margin",
                    100.0 * *test_.margin, 100.0 * accuracy));
  }
  margin_loss_ = *test_.margin / accuracy;
}

RehearsedStudy::PlannedSchedule RehearsedStudy::planned_visit(const study::Study& study,
                                                              const study::StudyKey& key,
                                                              int number, int visit) const {
  PlannedSchedule planned;
  planned.schedule =
      study::make_schedule(study, key.draw_of(number, study::Draws::rehearsal, visit));
  for (const int class_index : planned.schedule.layout) {
    planned.pictures.push_back(study.classes[class_index].label);
  }
  planned.order_block = study::order_block_of(study, key.stations, number, study::Draws::rehearsal);
  planned.course = simulation::course_of(study, planned.schedule);
  for (std::size_t i = 0; i < planned.course.size(); ++i) {
    const int interval = study.trials.break_every;
    planned.break_before.push_back(interval > 0 && i > 0 && static_cast<int>(i) % interval == 0);
  }
  return planned;
}

double RehearsedStudy::accuracy_of(int people) const {
  const auto size = std::min(static_cast<int>(schedules_.size()) / visits_, people);
  analysis::Proportion right;
  for (int people_done = 0; people_done < people; people_done += size) {
    RandomStream seeds(0, "power: methods alike", static_cast<std::uint64_t>(people_done));
    const analysis::Outcomes simulated = outcomes(size, Hypothesis::population, seeds.bits());
    for (const analysis::TrialOutcome& trial : simulated.trials) {
      if (trial.stimulus.method != test_.first) continue;
      right.add(trial.correct());
    }
  }
  return right.share().value_or(0.0);
}

study::StimulusIndex RehearsedStudy::felt_stimulus(const study::StimulusIndex& presented,
                                                   Hypothesis hypothesis,
                                                   std::uint64_t draw) const {
  if (hypothesis == Hypothesis::population && !test_.margin) return presented;
  if (test_.estimand == study::Estimand::mean_accuracy)
    return first_method_stimuli_[draw % first_method_stimuli_.size()];
  study::StimulusIndex felt = presented;
  if (felt.method == test_.first || felt.method == test_.second) {
    felt.method = draw % 2 == 0 ? test_.first : test_.second;
  }
  return felt;
}

/// One participant of a simulated study, with random streams that only planning uses.
struct RehearsedStudy::Person {
  Person(const SharedInput& shared, int participant)
      : number(participant),
        knowledge(
            simulation::memory_of(shared.knowledge, shared.subject, shared.study_seed, number)),
        individual(shared.subject, shared.study_seed, number),
        decision(individual, *knowledge),
        draws(shared.study_seed, "power: feelings", static_cast<std::uint64_t>(number)) {}

  int number;
  std::shared_ptr<const simulation::FeltKnowledge> knowledge;
  simulation::Individual individual;
  simulation::FeltDecision decision;
  /// One stream per participant, because constructing a stream takes longer than simulating a
  /// trial.
  RandomStream draws;
  std::optional<RandomStream> losses;
};

int RehearsedStudy::position_after_loss(int position, double loss, Person& person, int right,
                                        const study::Schedule& schedule) {
  if (loss <= 0.0 || schedule.layout[position] != right) return position;
  if (person.losses->uniform() >= loss) return position;
  return another_position(position, schedule.layout.size(), *person.losses);
}

void RehearsedStudy::add_participant(int number, const SharedInput& shared,
                                     analysis::Outcomes& outcomes) const {
  Person person(shared, number);
  if (margin_loss_ > 0.0) {
    person.losses.emplace(shared.study_seed, "power: losses", static_cast<std::uint64_t>(number));
  }
  for (int visit = 1; visit <= visits_; ++visit) add_visit(person, visit, shared, outcomes);
}

void RehearsedStudy::add_visit(Person& person, int visit, const SharedInput& shared,
                               analysis::Outcomes& outcomes) const {
  const int session = (person.number - 1) * visits_ + visit;
  const PlannedSchedule& planned = schedules_[static_cast<std::size_t>(session) - 1];
  const simulation::MatchedPictures pictures = simulation::match_pictures(
      planned.pictures, shared.subject, person.individual, *person.knowledge);
  simulation::Condition condition(shared.subject, shared.study_seed, person.number, visit,
                                  static_cast<int>(planned.course.size()));
  outcomes.sessions.push_back(
      completed_session(person.number, session, visit, planned.order_block));
  FeltTrial trial{shared.study_seed, person.number,
                  simulation::SimulatedParticipant::trials_before(visit), 0};
  for (std::size_t i = 0; i < planned.course.size(); ++i) {
    const study::Trial& presented = planned.schedule.trials[i];
    const bool is_scored = presented.role == study::Role::scored;
    simulation::TrialPlace place = planned.course[i];
    const int trial_number = static_cast<int>(i) + 1;
    if (planned.break_before[i]) condition.rest(trial_number - 1);
    ++trial.nth;
    trial.draw = person.draws.bits();
    trial.gain_db = presented.planes.front().gain_db;
    const std::uint64_t null_draw = person.draws.bits();
    if (!place.carries_over) condition.forget();
    // Unscored trials are simulated only if they affect the next answer.
    if (!is_scored && !(shared.subject.serial.is_on() && place.carries_over)) continue;
    const study::StimulusIndex felt =
        felt_stimulus(presented.field(), shared.hypothesis, null_draw);
    RandomStream random = simulation::stream_of_trial(trial.study_seed, simulation::kAnswerPurpose,
                                                      trial.participant, trial.nth);
    int position = person.decision
                       .answer(perception_.felt(felt, trial), pictures, random,
                               condition.effects_on(trial_number, place.block))
                       .position;
    if (is_scored) {
      const bool is_worse =
          shared.hypothesis == Hypothesis::null && presented.field().method == test_.first;
      const double loss = is_worse ? margin_loss_ : 0.0;
      position = position_after_loss(position, loss, person, presented.field().class_index,
                                     planned.schedule);
      outcomes.trials.push_back(
          answered_trial(person.number, session, visit, presented, planned.schedule, position));
    }
    if (!shared.subject.serial.is_on()) continue;
    place.label = empty_.classes[felt.class_index];
    simulation::end_trial(condition, place, position, pictures, *person.knowledge);
  }
}

analysis::Outcomes RehearsedStudy::outcomes(int participants, Hypothesis hypothesis,
                                            std::uint64_t study_seed) const {
  analysis::Outcomes outcomes = empty_;
  const std::shared_ptr<const simulation::FeltKnowledge> knowledge =
      perception_.knowledge(study_seed);
  const SharedInput shared{subject_, knowledge, hypothesis, study_seed};
  for (int number = 1; number <= participants; ++number) {
    add_participant(number, shared, outcomes);
  }
  return outcomes;
}

}  // namespace touchtrial::planning::identification
