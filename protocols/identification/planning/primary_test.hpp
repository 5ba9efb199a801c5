/// \file The primary test of a study, and its result in one simulated study. Source:
/// docs/planning.md, "The primary test"; docs/statistics.md.
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

/// The primary test. The study registers test, sides and level; otherwise the protocol's defaults
/// apply.
using PrimaryTest = choices::PrimaryQuestion;

/// The primary test of the study's protocol.
/// \param methods  first minus second; required if the study presents more than two methods
/// \throws UsageError if `methods` is missing, or is present although the study presents only one
///   method, or does not name two of its methods
[[nodiscard]] PrimaryTest primary_test_of(const study::Study& study,
                                          const std::optional<MethodLabels>& methods);

/// Converts a test to a test of non-inferiority of the first method.
/// \throws UsageError if the test does not compare two methods, or the margin is not in (0, 1]
[[nodiscard]] PrimaryTest as_noninferiority_test(PrimaryTest test, double margin);

/// \return for example "mean accuracy with adaptive against chance: one-sample t test over
///   participants, one-sided, level 0.05"
[[nodiscard]] std::string words_of(const PrimaryTest& test, const study::Study& study);
/// The name of PowerRun::estimate if two methods are compared.
inline constexpr std::string_view kDifferenceWords = "difference of accuracies";
/// \return the name of PowerRun::estimate: "accuracy" or kDifferenceWords
[[nodiscard]] std::string estimate_words(const PrimaryTest& test);

/// The result of one simulated study.
struct PowerRun {
  double p = 1.0;
  /// The largest possible p of the sign flips within the level; for t tests, the level; 0 if not
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
