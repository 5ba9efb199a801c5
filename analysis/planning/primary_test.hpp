/// \file The test that decides a study, and its result in one simulated study.
/// Source: docs/power.md, "The primary test"; docs/statistics.md.
#pragma once

#include "analysis/outcomes.hpp"
#include "protocols/design/study.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace touchtrial::planning {

/// The labels of two methods in the study file.
using MethodLabels = std::pair<std::string, std::string>;

struct PrimaryTest {
  enum class Kind {
    above_chance,    ///< right answers with one method, permuting the design's orders, one-sided
    methods_differ,  ///< comparison: sign flips over participants, two-sided
  };
  Kind kind = Kind::above_chance;
  int first = 0;   ///< index of a method
  int second = 1;  ///< index of a method; for `methods_differ` only
};

/// The primary test of the study's protocol.
/// \param methods  of a comparison, first minus second; required if it has more than two
/// \throws UsageError if they are not two of the study's methods, if they are missing, or if the
///   study presents one method only
[[nodiscard]] PrimaryTest primary_test_of(const design::Study& study,
                                          const std::optional<MethodLabels>& methods);

/// \return for instance "accuracy above chance (adaptive): permutation over the orders of the
///   design, one-sided, level 0.05"
[[nodiscard]] std::string words_of(const PrimaryTest& test, const design::Study& study);
/// What PowerRun::estimate is where two methods are compared.
inline constexpr std::string_view kDifferenceWords = "difference of accuracies";
/// \return what PowerRun::estimate is: "accuracy" or kDifferenceWords
[[nodiscard]] std::string estimate_words(const PrimaryTest& test);

/// The result of one simulated study.
struct PowerRun {
  double p = 1.0;
  double attainable = 0.0;  ///< largest p within the level; 0 if not computed
  double estimate = 0.0;    ///< mean over participants: accuracy, or difference of accuracies
  double low = 0.0;         ///< its 95 % t interval
  double high = 0.0;

  [[nodiscard]] double width() const noexcept { return high - low; }

  friend bool operator==(const PowerRun&, const PowerRun&) = default;
};

/// The numbers that the report gives for these outcomes. If the study's rule draws the orders, p
/// comes from 999 drawings.
/// \param with_attainable  whether to compute PowerRun::attainable
[[nodiscard]] PowerRun judged(const PrimaryTest& test, const analysis::Outcomes& outcomes,
                              bool with_attainable);

/// Whether p lies within the significance level.
[[nodiscard]] bool is_significant(const PowerRun& run) noexcept;

}  // namespace touchtrial::planning
