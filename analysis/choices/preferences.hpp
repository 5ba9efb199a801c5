/// \file Tests of whether participants prefer an answer regardless of what they felt. The tests are
/// by person, because different preferences cancel out in a mean. Sources: docs/statistics.md, "Any
/// participant" and "Preferences".
#pragma once

#include "analysis/choices/answers.hpp"
#include "analysis/statistics/global_null_test.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::choices {

/// One participant's answers.
struct Preference {
  std::string participant;
  int choice = 0;              ///< named most often beyond expectation
  std::optional<int> place{};  ///< its place in the last session, from 0; only if layouts differ
  int answers = 0;
  int named_count = 0;         ///< answers that name the choice
  Proportion right_there;      ///< right answers where the choice was right
  Proportion right_elsewhere;  ///< right answers where another choice was right
  double p = 1.0;              ///< null hypothesis: no preference
  double p_holm = 1.0;         ///< over participants
};

struct Preferences {
  std::vector<Preference> people;  ///< only those with an answer
  GlobalNullResult global_null;

  /// The people with p <= kSignificanceLevel, if anybody prefers a choice.
  [[nodiscard]] std::vector<const Preference*> people_with_preference() const;
};

/// Tests preferences in studies that draw the right choice of each trial uniformly from m choices.
/// Without a preference, accuracy does not depend on the right choice, and wrong answers are
/// uniform. If c is the accuracy over n trials and choice k was right in T_k of them, then
///   S_k = named_k - c T_k - (1 - c) (n - T_k) / (m - 1)
/// has mean 0. The test redraws the choices, but not which answers are right, because levels may
/// follow from these. The statistic is the sum of squares of S_k.
[[nodiscard]] Preferences preferences_by_target(std::span<const Person> people, int choices,
                                                const TrialFilter& is_included,
                                                int max_deals = analysis::kGlobalNullDeals);

/// Tests preferences in studies with stimuli of unknown similarity. If nobody has individual
/// preferences, wrong answers that confuse two stimuli name either one independently of the
/// participant; each deal permutes the names among people. A preference for one stimulus that
/// everybody shares counts as confusion. A place that everybody prefers is detected, because
/// layouts differ.
/// \param people  with scored trials; trials without an answer do not count
[[nodiscard]] Preferences preferences_among_errors(std::span<const Person> people, int choices,
                                                   int max_deals = analysis::kGlobalNullDeals);

/// One place on the answer screen.
struct PlaceUse {
  int named_count = 0;
  GroupTest excess;  ///< share of participants' answers minus 1 / places
};

/// Answers by their places in layouts that are drawn at random for each participant.
struct AnswersByPlace {
  std::vector<PlaceUse> places;  ///< in the order of the screen
  double p = 1.0;                ///< null hypothesis: no place is preferred; layouts are redrawn
  int deals = 0;                 ///< of layouts
  Preferences preferences;       ///< preferences_among_errors
};

/// \param people  as in preferences_among_errors
/// \return nothing without an answer at a place
[[nodiscard]] std::optional<AnswersByPlace> answers_by_place(std::span<const Person> people,
                                                             int choices);

}  // namespace touchtrial::choices
