/// \file The selections of sessions and trials under which a registered question is answered.
/// Source: docs/statistics.md, "The registered question".
#pragma once

#include "analysis/choices/people.hpp"

#include <set>
#include <string>
#include <vector>

namespace touchtrial::choices {

/// Which sessions and which of their trials enter an estimate.
struct Selection {
  std::string name;   ///< "registered", "taken", "put_back", "all", "valid", "answered"
  std::string words;  ///< what it excludes
  std::set<int> sessions;
  bool only_valid = false;
  bool only_answered = false;

  /// Whether the selection includes a trial of any kind.
  [[nodiscard]] bool admits(const TrialOutcome& trial) const {
    return has_ended(trial) && sessions.contains(trial.row.session) &&
           (!only_valid || trial.valid()) && (!only_answered || trial.response);
  }
  /// Whether it includes a scored trial.
  [[nodiscard]] bool has(const TrialOutcome& trial) const { return trial.scored && admits(trial); }
};

/// The registered choice first.
[[nodiscard]] std::vector<Selection> selections(const Outcomes& outcomes);

/// The people with all required visits, by their first session.
[[nodiscard]] std::set<int> people_with_all_visits(const Outcomes& outcomes,
                                                   const Selection& selection,
                                                   const FirstSessions& people);

/// ", over all visits"; empty in a study with one.
[[nodiscard]] std::string visit_words(const study::Study& study);

}  // namespace touchtrial::choices
