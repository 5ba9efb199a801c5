/// \file Outcomes for which a test gives every trial.
#pragma once

#include "analysis/hand_made_study.hpp"
#include "analysis/outcomes/outcomes.hpp"
#include "protocols/identification/study/identification.hpp"

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial {

/// One trial of HandMadeOutcomes.
struct HandMadeTrial {
  int session = 1;
  int felt = 0;                 ///< class
  std::optional<int> answered;  ///< class, or no response
  int method = 0;
  int answered_after_s = 1;  ///< from plane-on; first contact after 0.5 s
  bool within_limits = true;
  study::Role role = study::Role::scored;
};

/// Classes bark and cloth, methods as named; sessions are of P1, P2 and so on, enrolled in order.
class HandMadeOutcomes {
 public:
  explicit HandMadeOutcomes(std::vector<std::string> methods = {"adaptive"}) {
    outcomes.design.protocol = methods.size() > 1 ? &study::identification::comparison()
                                                  : &study::identification::classification();
    outcomes.classes = {"bark", "cloth"};
    outcomes.choices = outcomes.classes;
    outcomes.exemplars = {{"bark.png"}, {"cloth.png"}};
    outcomes.methods = std::move(methods);
    outcomes.state.closed = true;
    outcomes.state.unblinded = true;
  }

  analysis::SessionOutcome& session(bool counted = true) { return add_session(outcomes, counted); }

  /// Each method is a block of its own.
  void trial(const HandMadeTrial& of) {
    const auto place = static_cast<int>(outcomes.trials.size()) + 1;
    analysis::TrialOutcome trial;
    trial.participant = "P" + std::to_string(of.session);
    trial.row.session = of.session;
    trial.row.trial = place;
    trial.row.block = of.method;
    trial.row.state = of.answered ? record::TrialState::answered : record::TrialState::timed_out;
    trial.row.presented_at = std::chrono::seconds(100 * place);
    trial.row.contact_at = trial.row.presented_at + std::chrono::milliseconds(500);
    if (of.answered) {
      trial.row.answered_at = trial.row.presented_at + std::chrono::seconds(of.answered_after_s);
    }
    trial.row.valid = of.within_limits;
    trial.stimulus = {of.felt, 0, of.method};
    trial.role = of.role;
    trial.has_stimulus = of.role != study::Role::catch_trial;
    trial.scored = of.role == study::Role::scored;
    trial.counted = trial.scored && outcomes.sessions.at(of.session - 1).counted;
    trial.response = of.answered;
    if (of.role != study::Role::catch_trial) trial.right = of.felt;
    outcomes.trials.push_back(trial);
  }

  analysis::Outcomes outcomes;
};

}  // namespace touchtrial
