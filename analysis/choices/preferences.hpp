/// \file Tests of whether participants prefer an answer whatever they felt. The tests are by
/// person, because different preferences cancel out in a mean. Sources: docs/statistics.md, "Any
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
  int choice = 0;              ///< the one named most often beyond expectation
  std::optional<int> place{};  ///< its place in the last session, from 0; only if layouts differ
  int answers = 0;
  int named = 0;               ///< of them, those that name it
  Proportion right_there;      ///< right answers where it was right
  Proportion right_elsewhere;  ///< and where another choice was
  double p = 1.0;              ///< that there is no preference
  double p_holm = 1.0;         ///< over participants
};

struct Preferences {
  std::vector<Preference> people;  ///< with an answer
  GlobalNullResult anybody;

  /// The people whose own p is within the level, if anybody prefers a choice.
  [[nodiscard]] std::vector<const Preference*> of_those_who_prefer() const;
};

/// For studies that draw the right choice of each trial, all m choices being equally likely.
/// Without a preference, accuracy does not depend on which choice is right, and wrong answers are
/// spread evenly. With c the share right of n trials and choice k right in T_k of them, S_k =
/// named_k - c T_k - (1 - c) (n - T_k) / (m - 1) then has mean 0. Right answers keep their places,
/// which levels may follow, and choices are redrawn; p is of the sum of squares of S_k.
[[nodiscard]] Preferences preferences_by_target(std::span<const Person> people, int choices,
                                                const Which& which,
                                                int most_deals = analysis::kGlobalNullDeals);

/// For studies with stimuli of unknown similarity. Among wrong answers that confuse two stimuli,
/// which one was named does not depend on the participant if nobody has preferences of their own;
/// each deal permutes the names between people. A preference that everybody has for one stimulus
/// counts as confusion. A place that everybody prefers is detected, because each participant has a
/// different layout.
/// \param people  with scored trials; those without an answer do not count
[[nodiscard]] Preferences preferences_among_errors(std::span<const Person> people, int choices,
                                                   int most_deals = analysis::kGlobalNullDeals);

/// One place on the answer screen.
struct PlaceUse {
  int named = 0;
  GroupTest excess;  ///< share of participants' answers less 1 / places
};

/// Answers by their places in layouts that are drawn at random for each participant.
struct AnswersByPlace {
  std::vector<PlaceUse> places;  ///< in the order of the screen
  double p = 1.0;                ///< that all people together prefer no place; layouts are redrawn
  int deals = 0;                 ///< of layouts
  Preferences own;               ///< preferences_among_errors
};

/// \param people  as above
/// \return nothing without an answer at a place
[[nodiscard]] std::optional<AnswersByPlace> answers_by_place(std::span<const Person> people,
                                                             int choices);

}  // namespace touchtrial::choices
