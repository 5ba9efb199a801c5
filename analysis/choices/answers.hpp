/// \file Answers held against guessing, and the habits of those who answer: a preference for a
/// choice, and repeating the answer before.
#pragma once

#include "analysis/choices/people.hpp"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::choices {

/// A mean over participants of any numbers, and the t test of it against 0.
struct GroupTest {
  MeanEstimate mean;
  std::optional<double> p{};  ///< two-sided
};

[[nodiscard]] MeanEstimate unbounded_mean(std::span<const double> values);
[[nodiscard]] GroupTest group_test(std::span<const double> values);

/// Right answers where there is one guess rate.
struct RightAnswers {
  std::string participant;  ///< empty: all of them
  Proportion answers;
  Interval interval;               ///< Clopper and Pearson's
  std::optional<double> p{};       ///< of as many right answers or more by guessing: exact binomial
  std::optional<double> p_holm{};  ///< over participants
};

struct AgainstGuessing {
  RightAnswers pooled;
  std::vector<RightAnswers> people;  ///< those with such a trial
};

/// Which trials are meant.
using Which = std::function<bool(const TrialOutcome&)>;

/// \param guess  the share right by guessing
/// \return nothing without such a trial
[[nodiscard]] std::optional<AgainstGuessing> against_guessing(std::span<const Person> people,
                                                              double guess, const Which& which);

/// One choice: how often it was named, and how often it was right.
struct ChoiceUse {
  std::string choice;
  int named = 0;
  int targets = 0;
  GroupTest excess;  ///< share named less share right, over participants
};

[[nodiscard]] std::vector<ChoiceUse> choice_use_of(std::span<const Person> people,
                                                   const std::vector<std::string>& choices,
                                                   const Which& which);

/// How often an answer repeats the one before it, after right or after wrong answers. `expected` is
/// what a participant's own shares of answers give in any order, so that a preference for a choice
/// is not taken for repetition.
struct Repetition {
  Proportion repeats;  ///< all participants' trials pooled
  std::optional<double> expected{};
  GroupTest excess;  ///< share less expected, over participants
};

/// Of trials after any trial but those of the control block, which has no hand.
/// \param people  with answered trials, as they were felt
/// \param after  whether the answer before was right
[[nodiscard]] Repetition repetition_of(std::span<const Person> people, bool after,
                                       const Which& which);

}  // namespace touchtrial::choices
