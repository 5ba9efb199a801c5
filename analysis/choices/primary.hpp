/// \file The primary question of an identification study: whether participants are right more often
/// than by chance, or more often with one method than with another. Source: docs/statistics.md,
/// "The registered question".
#pragma once

#include "analysis/choices/selections.hpp"
#include "analysis/report/registered.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::choices {

using analysis::CrossoverPerson;
using analysis::PrimaryResult;
using analysis::Sides;

struct PrimaryQuestion {
  study::Estimand estimand = study::Estimand::mean_accuracy;
  int first = 0;   ///< index of a method
  int second = 1;  ///< of a difference: the method that is subtracted
  study::RegisteredTest test = study::RegisteredTest::t;
  Sides sides = Sides::one;
  double alpha = 0.05;
  std::optional<double> smallest_effect{};
  std::optional<double> margin{};  ///< of a difference: how much worse the first method may be

  /// The level of the deciding interval: 1 - alpha, or 1 - 2 alpha with a margin.
  [[nodiscard]] double interval_level() const noexcept {
    return 1.0 - (margin ? 2.0 : 1.0) * alpha;
  }

  friend bool operator==(const PrimaryQuestion&, const PrimaryQuestion&) = default;
};

/// The question that the study registers; without one, the usual question of its protocol: for a
/// classification, the mean accuracy by a one-sided t test; for two methods, their difference by
/// two-sided sign flips, or by the period-adjusted t test if one came after the other.
/// \param methods  the number that the study presents
/// \return nothing if a study of three methods or more registers none
[[nodiscard]] std::optional<PrimaryQuestion> primary_question(const study::Study& study,
                                                              int methods);

/// "one-sample t test over participants, one-sided"
[[nodiscard]] std::string test_words(const PrimaryQuestion& question);

/// The test used in place of a t test if people do not differ: "sign flips over participants,
/// because these do not differ and there is no t, one-sided"
[[nodiscard]] std::string test_words_without_t(const PrimaryQuestion& question);

/// Every counted participant's accuracy with the first method, or difference of accuracies; of two
/// methods in blocks with the order and its block.
[[nodiscard]] std::vector<CrossoverPerson> primary_values(const PrimaryQuestion& question,
                                                          const Outcomes& outcomes);

/// For a difference: whether people who have both methods are above chance with each.
[[nodiscard]] std::vector<analysis::AboveChance> above_chance(const PrimaryQuestion& question,
                                                              const Outcomes& outcomes,
                                                              const Selection& selection);

struct PrimaryEstimate {
  std::optional<double> estimate{};
  std::optional<Interval> interval{};  ///< Student's
};

/// The estimate from these participants. Values that need more participants are missing.
/// \param level  of the interval
[[nodiscard]] PrimaryEstimate primary_estimate(const PrimaryQuestion& question,
                                               std::span<const CrossoverPerson> people,
                                               double level);

/// The p of the question's test.
/// \return nothing with too few participants
[[nodiscard]] std::optional<double> primary_p(const PrimaryQuestion& question, int classes,
                                              std::span<const CrossoverPerson> people);

/// Only the differences.
[[nodiscard]] std::vector<double> differences_of(std::span<const CrossoverPerson> people);

/// The answer under every selection of sessions and trials, with its decision.
/// \return nothing if the study has no question
[[nodiscard]] std::optional<PrimaryResult> primary_result(const Outcomes& outcomes);

}  // namespace touchtrial::choices
