/// \file Tests of answers against guessing and of attention in catch trials, and response habits: a
/// preference for a choice (by person: preferences.hpp), and repeating the previous answer.
#pragma once

#include "analysis/choices/people.hpp"
#include "analysis/statistics/global_null_test.hpp"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::choices {

using analysis::GlobalNullResult;

/// A mean over participants of any numbers, and the test of it against 0.
struct GroupTest {
  MeanEstimate mean;
  std::optional<double> p{};  ///< two-sided, by Student's t
  bool alike = false;  ///< all values are equal, so t does not exist and p is that of sign flips
};

[[nodiscard]] MeanEstimate unbounded_mean(std::span<const double> values);
[[nodiscard]] GroupTest group_test(std::span<const double> values);

/// Right answers where there is one guess rate.
struct RightAnswers {
  std::string participant;  ///< empty: all participants
  Proportion answers;
  Interval interval;               ///< Clopper and Pearson's
  std::optional<double> p{};       ///< exact binomial against guessing, one-sided
  std::optional<double> p_holm{};  ///< over participants
};

struct AgainstGuessing {
  RightAnswers pooled;
  std::vector<RightAnswers> people;  ///< those with such a trial
};

/// Selects trials.
using Which = std::function<bool(const TrialOutcome&)>;

/// \param guess  the share right by guessing
/// \return nothing without such a trial
[[nodiscard]] std::optional<AgainstGuessing> against_guessing(std::span<const Person> people,
                                                              double guess, const Which& which);

/// Tests whether anybody does better than guessing. Each participant has an exact p; a deal
/// simulates the answers of guessing; the statistic of all people is their number of right answers.
[[nodiscard]] GlobalNullResult test_anyone_above_chance(const AgainstGuessing& answers,
                                                        double guess,
                                                        int deals = analysis::kGlobalNullDeals);

/// The participants whose own p is within the level, if anybody does better than guessing.
[[nodiscard]] std::vector<std::string> people_above_chance(const AgainstGuessing& answers,
                                                           const GlobalNullResult& anybody);

inline constexpr double kFoundWith = 0.8;  ///< the probability of Detectable

/// The smallest accuracy that can be detected in one participant among several, by Holm's first
/// step.
struct Detectable {
  int trials = 0;  ///< of the participant with the fewest
  int right = 0;   ///< right answers needed; 0: even all right is not enough
  /// The share of right answers that is detected with probability kFoundWith.
  std::optional<double> share{};
};

[[nodiscard]] Detectable detectable_in(const AgainstGuessing& answers, double guess);

/// The minimum share of right catch trials for a participant who attends and understands.
inline constexpr double kAttentive = 0.95;

/// A test of one participant's attention by catch trials.
struct Attention {
  std::string participant;
  double p =
      1.0;  ///< exact binomial against kAttentive, one-sided: this few right answers or fewer
  double p_holm = 1.0;  ///< over participants

  [[nodiscard]] bool is_doubtful() const noexcept;
};

/// \param catches  right answers in catch trials
[[nodiscard]] std::vector<Attention> attention_of(const AgainstGuessing& catches);

/// One choice: how often it was answered, and how often it was right.
struct ChoiceUse {
  std::string choice;
  int named = 0;
  int targets = 0;
  GroupTest excess;  ///< share named less share right, over participants
};

[[nodiscard]] std::vector<ChoiceUse> choice_use_of(std::span<const Person> people,
                                                   const std::vector<std::string>& choices,
                                                   const Which& which);

/// How often an answer repeats the previous one, after right or after wrong answers. `expected`
/// follows from the participant's own shares of answers, so that a preference for a choice does not
/// look like repetition.
struct Repetition {
  Proportion repeats;  ///< all participants' trials pooled
  std::optional<double> expected{};
  GroupTest excess;  ///< share less expected, over participants
};

/// Counts trials that follow another trial, except in the control block, which has no hand.
/// \param people  with answered trials, as they were felt
/// \param after  whether the previous answer was right
[[nodiscard]] Repetition repetition_of(std::span<const Person> people, bool after,
                                       const Which& which);

}  // namespace touchtrial::choices
