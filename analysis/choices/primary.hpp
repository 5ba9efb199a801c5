/// \file The primary question of an identification study: whether accuracy is above chance, or
/// differs between two methods. Source: docs/statistics.md, "The registered question".
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
  int second = 1;  ///< of a difference: index of the subtracted method
  study::RegisteredTest test = study::RegisteredTest::t;
  Sides sides = Sides::one;
  double alpha = 0.05;
  std::optional<double> smallest_effect{};
  std::optional<double> margin{};  ///< of a difference: non-inferiority margin of the first method

  /// The level of the deciding interval: 1 - alpha, or 1 - 2 alpha with a margin.
  [[nodiscard]] double interval_level() const noexcept {
    return 1.0 - (margin ? 2.0 : 1.0) * alpha;
  }

  friend bool operator==(const PrimaryQuestion&, const PrimaryQuestion&) = default;
};

/// The question that the study registers. The default with one method is the mean accuracy by a
/// one-sided t test; with two methods, their difference by two-sided sign flips, or by the
/// period-adjusted t test if they are presented in blocks.
/// \param methods  the number of the study's methods
/// \return nothing if a study of three methods or more registers no question
[[nodiscard]] std::optional<PrimaryQuestion> primary_question(const study::Study& study,
                                                              int methods);

/// "one-sample t test over participants, one-sided"
[[nodiscard]] std::string test_words(const PrimaryQuestion& question);

/// The test that replaces a t test if people do not differ: "sign flips over participants,
/// because these do not differ and there is no t, one-sided"
[[nodiscard]] std::string test_words_without_t(const PrimaryQuestion& question);

/// Every counted participant's accuracy with the first method, or difference of accuracies. For two
/// methods in blocks, also the order of methods and the randomisation block of this order.
[[nodiscard]] std::vector<CrossoverPerson> primary_values(const PrimaryQuestion& question,
                                                          const Outcomes& outcomes);

/// Tests whether accuracy is above chance with each of the two methods of a difference.
[[nodiscard]] std::vector<analysis::AboveChance> above_chance(const PrimaryQuestion& question,
                                                              const Outcomes& outcomes,
                                                              const Selection& selection);

struct PrimaryEstimate {
  std::optional<double> estimate{};
  std::optional<Interval> interval{};  ///< by Student's t
};

/// Values that need more participants are missing.
/// \param level  of the interval
[[nodiscard]] PrimaryEstimate primary_estimate(const PrimaryQuestion& question,
                                               std::span<const CrossoverPerson> people,
                                               double level);

/// \return the p of the question's test, or nothing with too few participants
[[nodiscard]] std::optional<double> primary_p(const PrimaryQuestion& question, int classes,
                                              std::span<const CrossoverPerson> people);

[[nodiscard]] std::vector<double> differences_of(std::span<const CrossoverPerson> people);

/// The answer under every selection of sessions and trials, with the decision.
/// \return nothing if the study has no question
[[nodiscard]] std::optional<PrimaryResult> primary_result(const Outcomes& outcomes);

}  // namespace touchtrial::choices
