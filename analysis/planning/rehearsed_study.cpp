#include "analysis/planning/rehearsed_study.hpp"

#include "core/errors.hpp"
#include "core/random.hpp"
#include "protocols/session/felt_decision.hpp"

#include <fmt/format.h>

namespace touchtrial::planning {
namespace {

std::string participant_name(int number) {
  return fmt::format("P{:03}", number);
}

/// A study's outcomes before anybody took part.
analysis::Outcomes nobody_yet(const design::Study& study) {
  analysis::Outcomes outcomes;
  outcomes.study = study.name;
  outcomes.protocol = study.protocol;
  outcomes.simulated = true;
  outcomes.design = study;
  for (const design::StudyClass& one : study.classes) outcomes.classes.push_back(one.label);
  for (int i = 0; i < study.presented_methods(); ++i) {
    outcomes.methods.push_back(study.methods[i].label);
  }
  return outcomes;
}

std::vector<design::StimulusIndex> stimuli_of(const design::Study& study, int method) {
  std::vector<design::StimulusIndex> stimuli;
  for (int c = 0; c < static_cast<int>(study.classes.size()); ++c) {
    for (int e = 0; e < static_cast<int>(study.classes[c].images.size()); ++e) {
      stimuli.push_back({c, e, method});
    }
  }
  return stimuli;
}

/// Who explores until time is up, in a study that then takes no answer, answers nothing.
void require_answers(const design::Study& study, const session::SubjectModel& subject) {
  const bool in_time = subject.explore_s < study.trials.explore_limit_s;
  if (in_time || study.trials.on_timeout != design::OnTimeout::no_response) return;
  throw StudyError(one_line(fmt::format(
      "{}: /explore_s: {} s is not less than the study's explore_limit_s ({} s), after which "
      "it takes no answer (on_timeout \"no-response\"); nobody would ever answer: explore for less",
      subject.source, subject.explore_s, study.trials.explore_limit_s)));
}

analysis::SessionOutcome completed_session(int number) {
  analysis::SessionOutcome session;
  session.row.session = number;
  session.row.participant = participant_name(number);
  session.row.enrolment = number;
  session.row.state = store::SessionState::completed;
  session.row.simulated = true;
  session.counted = true;
  return session;
}

analysis::TrialOutcome answered_trial(int number, const design::Presentation& presentation,
                                      const design::Schedule& schedule, int position) {
  analysis::TrialOutcome trial;
  trial.participant = participant_name(number);
  trial.row.session = number;
  trial.row.trial = presentation.trial;
  trial.row.block = presentation.block;
  trial.row.state = store::TrialState::answered;
  trial.row.position = position;
  trial.stimulus = presentation.stimulus;
  trial.kind = presentation.kind;
  trial.scored = true;
  trial.counted = true;
  trial.response = schedule.layout[position];
  return trial;
}

}  // namespace

/// What all participants of one simulated study share.
struct RehearsedStudy::Answering {
  const session::FeltKnowledge& knowledge;
  Hypothesis hypothesis;
  std::uint64_t study_seed;
};

std::string_view name_of(Hypothesis hypothesis) {
  return hypothesis == Hypothesis::null ? "null" : "population";
}

RehearsedStudy::RehearsedStudy(const design::Study& study, const session::SubjectModel& subject,
                               const PrimaryTest& test, const Feelings& feelings,
                               int most_participants)
    : subject_(subject),
      test_(test),
      feelings_(feelings),
      of_method_(stimuli_of(study, test.first)),
      empty_(nobody_yet(study)) {
  require_answers(study, subject);
  for (int number = 1; number <= most_participants; ++number) {
    PlannedSchedule& planned = schedules_.emplace_back();
    planned.schedule = design::make_schedule(study, number);
    for (const int class_index : planned.schedule.layout) {
      planned.pictures.push_back(study.classes[class_index].label);
    }
  }
}

design::StimulusIndex RehearsedStudy::felt_stimulus(const design::StimulusIndex& presented,
                                                    Hypothesis hypothesis,
                                                    std::uint64_t draw) const {
  if (hypothesis == Hypothesis::population) return presented;
  if (test_.kind == PrimaryTest::Kind::above_chance) return of_method_[draw % of_method_.size()];
  design::StimulusIndex felt = presented;
  if (felt.method == test_.first || felt.method == test_.second) {
    felt.method = draw % 2 == 0 ? test_.first : test_.second;
  }
  return felt;
}

void RehearsedStudy::add_participant(int number, const Answering& answering,
                                     analysis::Outcomes& outcomes) const {
  const auto& [schedule, pictures] = schedules_[static_cast<std::size_t>(number) - 1];
  const session::Individual individual(subject_, answering.study_seed, number);
  const session::FeltDecision decision(individual, answering.knowledge);
  const session::SeenPictures seen =
      session::see(pictures, subject_, individual, answering.knowledge);
  // One stream a participant: making one takes longer than all else of a trial.
  RandomStream draws(answering.study_seed, "power: feelings", static_cast<std::uint64_t>(number));
  FeltTrial trial{answering.study_seed, number, 0, 0};
  for (const design::Presentation& presentation : schedule.presentations) {
    ++trial.nth;
    trial.draw = draws.bits();
    const std::uint64_t instead = draws.bits();
    if (presentation.kind != design::PresentationKind::scored) continue;
    const design::StimulusIndex felt =
        felt_stimulus(presentation.stimulus, answering.hypothesis, instead);
    RandomStream random = session::stream_of_trial(trial.study_seed, session::kAnswerPurpose,
                                                   trial.participant, trial.nth);
    const int position = decision.answer(feelings_.felt(felt, trial), seen, random).position;
    outcomes.trials.push_back(answered_trial(number, presentation, schedule, position));
  }
}

analysis::Outcomes RehearsedStudy::outcomes(int participants, Hypothesis hypothesis,
                                            std::uint64_t study_seed) const {
  analysis::Outcomes outcomes = empty_;
  const std::shared_ptr<const session::FeltKnowledge> knowledge = feelings_.knowledge(study_seed);
  const Answering answering{*knowledge, hypothesis, study_seed};
  for (int number = 1; number <= participants; ++number) {
    outcomes.sessions.push_back(completed_session(number));
    add_participant(number, answering, outcomes);
  }
  return outcomes;
}

}  // namespace touchtrial::planning
