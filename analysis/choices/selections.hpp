/// \file Every choice of sessions and trials under which a registered question is answered. Source:
/// docs/statistics.md, "The registered question".
#pragma once

#include "analysis/choices/people.hpp"

#include <set>
#include <string>
#include <vector>

namespace touchtrial::choices {

/// Which sessions and which of their trials enter an estimate.
struct Selection {
  std::string name;   ///< "registered", "taken", "put_back", "all", "valid", "answered"
  std::string words;  ///< what it leaves out
  std::set<int> sessions;
  bool valid_alone = false;
  bool answered_alone = false;

  /// Whether a trial of any kind is in it.
  [[nodiscard]] bool admits(const TrialOutcome& trial) const {
    return has_ended(trial) && sessions.contains(trial.row.session) &&
           (!valid_alone || trial.valid()) && (!answered_alone || trial.response);
  }
  /// Whether a scored trial is in it.
  [[nodiscard]] bool has(const TrialOutcome& trial) const { return trial.scored && admits(trial); }
};

/// The registered choice first.
[[nodiscard]] std::vector<Selection> selections(const Outcomes& outcomes);

/// The people, by their first session, who have all visits that decide.
[[nodiscard]] std::set<int> people_with_all_visits(const Outcomes& outcomes,
                                                   const Selection& selection,
                                                   const FirstSessions& people);

/// ", over all visits"; empty in a study with one.
[[nodiscard]] std::string visit_words(const study::Study& study);

}  // namespace touchtrial::choices
