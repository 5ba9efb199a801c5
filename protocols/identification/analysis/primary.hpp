/// \file The question that decides an identification study: whether participants are right more
/// often than by chance, or more often with one method than with another. Source:
/// docs/statistics.md, "The registered question".
#pragma once

#include "analysis/registered.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::analysis::identification {

struct PrimaryQuestion {
  design::Estimand estimand = design::Estimand::mean_accuracy;
  int first = 0;   ///< index of a method
  int second = 1;  ///< of a difference: the method that is subtracted
  design::RegisteredTest test = design::RegisteredTest::t;
  Sides sides = Sides::one;
  double alpha = 0.05;
  std::optional<double> smallest_effect{};

  friend bool operator==(const PrimaryQuestion&, const PrimaryQuestion&) = default;
};

/// The question that the study registers; without one, the usual question of its protocol: for a
/// classification, the mean accuracy by a one-sided t test; for two methods, their difference by
/// two-sided sign flips.
/// \param methods  the number that the study presents
/// \return nothing if a study of three methods or more registers none
[[nodiscard]] std::optional<PrimaryQuestion> primary_question(const design::Study& study,
                                                              int methods);

/// The estimand under the null hypothesis.
[[nodiscard]] double null_of(const PrimaryQuestion& question, int classes);

/// "one-sample t test over participants, one-sided"
[[nodiscard]] std::string test_words(const PrimaryQuestion& question);

/// The p of the question's test.
/// \param values  one accuracy, or one difference, per participant
/// \return nothing with too few participants
[[nodiscard]] std::optional<double> primary_p(const PrimaryQuestion& question, int classes,
                                              std::span<const double> values);

/// Every counted participant's accuracy with the first method, or difference of accuracies.
[[nodiscard]] std::vector<double> primary_values(const PrimaryQuestion& question,
                                                 const Outcomes& outcomes);

/// The answer under every choice of sessions and trials, judged.
/// \return nothing if the study has no question
[[nodiscard]] std::optional<PrimaryResult> primary_result(const Outcomes& outcomes);

}  // namespace touchtrial::analysis::identification
