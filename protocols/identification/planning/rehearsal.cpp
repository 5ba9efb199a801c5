#include "protocols/identification/planning/rehearsal.hpp"

#include "core/random.hpp"

#include <fmt/format.h>

namespace touchtrial::planning::identification {
namespace {

std::string participant_name(int number) {
  return fmt::format("P{:03}", number);
}

}  // namespace

std::string_view name_of(Hypothesis hypothesis) {
  return hypothesis == Hypothesis::null ? "null" : "population";
}

analysis::Outcomes empty_outcomes(const study::Study& study) {
  analysis::Outcomes outcomes;
  outcomes.study = study.name;
  outcomes.simulated = true;
  outcomes.design = study;
  for (const study::StudyClass& one : study.classes) outcomes.classes.push_back(one.label);
  outcomes.choices = outcomes.classes;
  for (int i = 0; i < study.presented_methods(); ++i) {
    outcomes.methods.push_back(study.methods[i].label);
  }
  return outcomes;
}

analysis::SessionOutcome completed_session(int number, int session_number, int visit,
                                           int order_block) {
  analysis::SessionOutcome session;
  session.row.session = session_number;
  session.row.visit = visit;
  session.row.participant = participant_name(number);
  session.row.enrolment = number;
  session.row.state = record::SessionState::completed;
  session.row.simulated = true;
  session.counted = true;
  session.order_block = order_block;
  return session;
}

analysis::TrialOutcome answered_trial(int number, int session, int visit,
                                      const study::Trial& presented,
                                      const study::Schedule& schedule, int position) {
  analysis::TrialOutcome trial;
  trial.participant = participant_name(number);
  trial.visit = visit;
  trial.row.session = session;
  trial.row.trial = presented.place.trial;
  trial.row.block = presented.place.block;
  trial.row.state = record::TrialState::answered;
  trial.row.answer = ChoiceAnswer{position};
  trial.stimulus = presented.field();
  trial.role = presented.role;
  trial.scored = true;
  trial.counted = true;
  trial.response = schedule.layout[position];
  trial.right = trial.stimulus.class_index;
  return trial;
}

int another_position(int position, std::size_t pictures, RandomStream& random) {
  const auto step = 1 + random.below(pictures - 1);
  return static_cast<int>((static_cast<std::uint64_t>(position) + step) % pictures);
}

}  // namespace touchtrial::planning::identification
