/// \file The selections of sessions and trials for which a registered question is answered.
/// Source: docs/statistics.md, "The registered question".
#pragma once

#include "analysis/choices/people.hpp"

#include <set>
#include <string>
#include <vector>

namespace touchtrial::choices {

/// The sessions and trials that enter an estimate.
struct Selection {
  std::string name;   ///< "registered", "taken", "put_back", "all", "valid", "answered"
  std::string words;  ///< what it excludes
  std::set<int> sessions;
  bool only_valid = false;
  bool only_answered = false;

  /// Whether the selection includes a trial, scored or not.
  [[nodiscard]] bool includes_any(const TrialOutcome& trial) const {
    return has_ended(trial) && sessions.contains(trial.row.session) &&
           (!only_valid || trial.valid()) && (!only_answered || trial.response);
  }
  /// Whether the trial is scored and included.
  [[nodiscard]] bool includes(const TrialOutcome& trial) const {
    return trial.scored && includes_any(trial);
  }
};

/// \return the registered selection first
[[nodiscard]] std::vector<Selection> selections(const Outcomes& outcomes);

/// The people who completed all required visits, by first session.
[[nodiscard]] std::set<int> people_with_all_visits(const Outcomes& outcomes,
                                                   const Selection& selection,
                                                   const FirstSessions& people);

/// ", over all visits"; empty with one visit.
[[nodiscard]] std::string visit_words(const study::Study& study);

}  // namespace touchtrial::choices
