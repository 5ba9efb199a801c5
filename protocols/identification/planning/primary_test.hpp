/// \file The primary test of a study, and its result in one simulated study.
/// Source: docs/planning.md, "The primary test"; docs/statistics.md.
#pragma once

#include "analysis/choices/primary.hpp"
#include "analysis/outcomes/outcomes.hpp"
#include "study/study.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace touchtrial::planning::identification {

/// The labels of two methods in the study file.
using MethodLabels = std::pair<std::string, std::string>;

/// The primary test. Test, sides and level are those that the study registers, or the defaults of
/// its protocol.
using PrimaryTest = choices::PrimaryQuestion;

/// The primary test of the study's protocol.
/// \param methods  of a comparison, first minus second; required if it has more than two
/// \throws UsageError if they are not two of the study's methods, if they are missing, or if the
///   study presents one method only
[[nodiscard]] PrimaryTest primary_test_of(const study::Study& study,
                                          const std::optional<MethodLabels>& methods);

/// Turns a test into a test of non-inferiority: whether the first method is as good as the second.
/// \throws UsageError if the test does not compare two methods, or the margin is not in (0, 1]
[[nodiscard]] PrimaryTest with_margin(PrimaryTest test, double margin);

/// \return for instance "mean accuracy with adaptive against chance: one-sample t test over
///   participants, one-sided, level 0.05"
[[nodiscard]] std::string words_of(const PrimaryTest& test, const study::Study& study);
/// Name of PowerRun::estimate if two methods are compared.
inline constexpr std::string_view kDifferenceWords = "difference of accuracies";
/// \return the name of PowerRun::estimate: "accuracy" or kDifferenceWords
[[nodiscard]] std::string estimate_words(const PrimaryTest& test);

/// The result of one simulated study.
struct PowerRun {
  double p = 1.0;
  /// The maximum p of the sign flips within the level; for t tests, the level itself; 0 if not
  /// computed.
  double attainable = 0.0;
  double estimate = 0.0;  ///< mean over participants: accuracy, or difference of accuracies
  double low = 0.0;       ///< 95 % t interval of the estimate, period-adjusted if the test is
  double high = 0.0;

  [[nodiscard]] double width() const noexcept { return high - low; }

  friend bool operator==(const PowerRun&, const PowerRun&) = default;
};

/// Analyses outcomes as the report does.
/// \param with_attainable  whether to compute PowerRun::attainable
[[nodiscard]] PowerRun analyse_run(const PrimaryTest& test, const analysis::Outcomes& outcomes,
                                   bool with_attainable);

/// Whether p lies within the significance level.
[[nodiscard]] bool is_significant(const PowerRun& run, double level) noexcept;

}  // namespace touchtrial::planning::identification
