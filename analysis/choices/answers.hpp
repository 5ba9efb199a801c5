/// \file Tests of answers against guessing and of attention in catch trials, and response habits:
/// preferences for a choice (by person: preferences.hpp), and repetition of the previous answer.
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

/// A mean over participants and its test against 0.
struct GroupTest {
  MeanEstimate mean;
  std::optional<double> p{};  ///< two-sided, by Student's t
  bool all_equal = false;     ///< all values are equal, so t is undefined and p is from sign flips
};

[[nodiscard]] MeanEstimate unbounded_mean(std::span<const double> values);
[[nodiscard]] GroupTest group_test(std::span<const double> values);

/// Correct answers of trials that share a guess rate.
struct RightAnswers {
  std::string participant;  ///< empty: all participants
  Proportion answers;
  Interval interval;               ///< Clopper-Pearson
  std::optional<double> p{};       ///< exact binomial test against guessing, one-sided
  std::optional<double> p_holm{};  ///< over participants
};

struct GuessingTests {
  RightAnswers pooled;
  std::vector<RightAnswers> people;  ///< only those with a selected trial
};

/// Selects trials.
using TrialFilter = std::function<bool(const TrialOutcome&)>;

/// \param guess  the accuracy of guessing
/// \return nothing if no trial is selected
[[nodiscard]] std::optional<GuessingTests> test_against_guessing(std::span<const Person> people,
                                                                 double guess,
                                                                 const TrialFilter& is_included);

/// Tests whether anybody does better than guessing. Each participant has an exact p; each deal
/// simulates guessing; the pooled statistic is the number of right answers.
[[nodiscard]] GlobalNullResult test_anyone_above_chance(const GuessingTests& answers, double guess,
                                                        int deals = analysis::kGlobalNullDeals);

/// The participants with p <= kSignificanceLevel, if the global test finds that anybody does better
/// than guessing.
[[nodiscard]] std::vector<std::string> people_above_chance(const GuessingTests& answers,
                                                           const GlobalNullResult& global_null);

inline constexpr double kDetectionPower = 0.8;  ///< of DetectableAccuracy

/// The smallest accuracy that can be detected in one participant among several, by Holm's first
/// step.
struct DetectableAccuracy {
  int trials = 0;  ///< of the participant with the fewest
  int right = 0;   ///< right answers needed; 0: no number is enough
  /// The accuracy that is detected with probability kDetectionPower.
  std::optional<double> share{};
};

[[nodiscard]] DetectableAccuracy detectable_accuracy(const GuessingTests& answers, double guess);

/// The minimum catch-trial accuracy of a participant who attends and understands.
inline constexpr double kMinCatchAccuracy = 0.95;

/// A test of one participant's attention by catch trials.
struct Attention {
  std::string participant;
  double p = 1.0;       ///< exact binomial test of accuracy below kMinCatchAccuracy, one-sided
  double p_holm = 1.0;  ///< over participants

  [[nodiscard]] bool is_doubtful() const noexcept;
};

/// \param catches  right answers in catch trials
[[nodiscard]] std::vector<Attention> attention_of(const GuessingTests& catches);

/// One choice: how often it was answered, and how often it was right.
struct ChoiceUse {
  std::string choice;
  int named_count = 0;
  int target_count = 0;
  GroupTest excess;  ///< share named minus share right, over participants
};

[[nodiscard]] std::vector<ChoiceUse> choice_use_of(std::span<const Person> people,
                                                   const std::vector<std::string>& choices,
                                                   const TrialFilter& is_included);

/// How often an answer repeats the previous one, after right or after wrong answers. `expected`
/// follows from each participant's distribution of answers, so that a preference for a choice does
/// not look like repetition.
struct Repetition {
  Proportion repeats;  ///< all participants' trials pooled
  std::optional<double> expected{};
  GroupTest excess;  ///< share minus expected, over participants
};

/// Counts trials that follow another trial, except in the control block, where no hand feels.
/// \param people  with answered trials, in felt order
/// \param after_right  whether trials after right or after wrong answers are counted
[[nodiscard]] Repetition repetition_of(std::span<const Person> people, bool after_right,
                                       const TrialFilter& is_included);

}  // namespace touchtrial::choices
