/// \file What outcomes share for which a test gives every trial.
#pragma once

#include "analysis/outcomes/outcomes.hpp"

#include <chrono>
#include <string>
#include <vector>

namespace touchtrial {

/// A closed and unblinded study of these classes, each with one image.
inline void set_classes(analysis::Outcomes& outcomes, const std::vector<std::string>& classes) {
  for (const std::string& label : classes) {
    study::StudyClass& added = outcomes.design.classes.emplace_back();
    added.label = label;
    added.images.emplace_back(label + ".png");
    outcomes.exemplars.push_back({label + ".png"});
  }
  outcomes.classes = classes;
  outcomes.state.closed = true;
  outcomes.state.unblinded = true;
}

/// Adds the complete session of the next of P1, P2 and so on.
inline analysis::SessionOutcome& add_session(analysis::Outcomes& outcomes, bool counted = true) {
  const int number = static_cast<int>(outcomes.sessions.size()) + 1;
  analysis::SessionOutcome& added = outcomes.sessions.emplace_back();
  added.row.session = number;
  added.row.participant = "P" + std::to_string(number);
  added.row.enrolment = number;
  added.row.state = record::SessionState::completed;
  added.counted = counted;
  return added;
}

/// Adds a trial of a session, answered after 8 s.
inline analysis::TrialOutcome& add_trial(analysis::Outcomes& outcomes, int session) {
  const auto place = static_cast<int>(outcomes.trials.size()) + 1;
  analysis::TrialOutcome& trial = outcomes.trials.emplace_back();
  trial.participant = "P" + std::to_string(session);
  trial.row.session = session;
  trial.row.trial = place;
  trial.row.state = record::TrialState::answered;
  trial.row.presented_at = std::chrono::seconds(20 * place);
  trial.row.answered_at = trial.row.presented_at + std::chrono::seconds(8);
  return trial;
}

}  // namespace touchtrial
