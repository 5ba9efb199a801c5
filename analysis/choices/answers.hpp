/// \file Answers held against guessing and against somebody who attends, and the habits of those who
/// answer: a preference for a choice (by person: preferences.hpp), and repeating the answer before.
#pragma once

#include "analysis/choices/people.hpp"
#include "analysis/statistics/anybody.hpp"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::choices {

using analysis::Anybody;

/// A mean over participants of any numbers, and the test of it against 0.
struct GroupTest {
  MeanEstimate mean;
  std::optional<double> p{};  ///< two-sided, by Student's t
  bool alike = false;         ///< all values are, so that t does not exist: p is that of sign flips
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

/// Whether anybody does better than guessing: exact p of each participant; deals draw right answers
/// by guessing; of all together counts the number of right answers.
[[nodiscard]] Anybody anybody_better(const AgainstGuessing& answers, double guess,
                                     int deals = analysis::kAnybodyDeals);

/// Those whose own p is within the level, if anybody does better than guessing.
[[nodiscard]] std::vector<std::string> those_better(const AgainstGuessing& answers,
                                                    const Anybody& anybody);

inline constexpr double kFoundWith = 0.8;  ///< the probability of Detectable

/// What so few trials can show of one participant among several, by Holm's first step.
struct Detectable {
  int trials = 0;  ///< of the participant with the fewest
  int right = 0;   ///< as many are needed; 0: all of them are not enough
  /// Somebody who is right in this share of trials is found with a probability of kFoundWith.
  std::optional<double> share{};
};

[[nodiscard]] Detectable detectable_in(const AgainstGuessing& answers, double guess);

/// The share of catch trials that somebody who attends and understands has right at least.
inline constexpr double kAttentive = 0.95;

/// How well a participant's catch trials agree with attending.
struct Attention {
  std::string participant;
  double p = 1.0;       ///< of as few right answers or fewer at kAttentive: exact binomial
  double p_holm = 1.0;  ///< over participants

  [[nodiscard]] bool is_doubtful() const noexcept;
};

/// \param catches  right answers in catch trials
[[nodiscard]] std::vector<Attention> attention_of(const AgainstGuessing& catches);

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
