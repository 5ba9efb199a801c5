/// \file The test that decides a study, and what one simulated study makes of it.
/// Source: docs/power.md, "The primary test"; docs/statistics.md.
#pragma once

#include "analysis/outcomes.hpp"
#include "protocols/design/study.hpp"

#include <optional>
#include <string>
#include <utility>

namespace touchtrial::planning {

/// Two methods by their labels in the study file.
using MethodLabels = std::pair<std::string, std::string>;

struct PrimaryTest {
  enum class Kind {
    above_chance,    ///< classification: right answers over the design's orders, one-sided
    methods_differ,  ///< comparison: sign flips over participants, two-sided
  };
  Kind kind = Kind::above_chance;
  int first = 0;   ///< index of a method
  int second = 1;  ///< the same, of `methods_differ` alone
};

/// That of the study's protocol.
/// \param methods  of a comparison, first minus second; needed where there are three or more
/// \throws UsageError if they are not two of the study's methods, or missing, or of no use
[[nodiscard]] PrimaryTest primary_test_of(const design::Study& study,
                                          const std::optional<MethodLabels>& methods);

/// "accuracy above chance (adaptive): permutation over the design, one-sided, level 0.05"
[[nodiscard]] std::string words_of(const PrimaryTest& test, const design::Study& study);
/// What `PowerRun::estimate` is: "accuracy", or "difference of accuracies".
[[nodiscard]] std::string estimate_words(const PrimaryTest& test);

/// What one simulated study came to.
struct PowerRun {
  double p = 1.0;
  double attainable = 0.0;  ///< largest p within the level; 0 where nobody asked
  double estimate = 0.0;    ///< mean over participants: accuracy, or difference of accuracies
  double low = 0.0;         ///< its 95 % t interval
  double high = 0.0;

  [[nodiscard]] double width() const noexcept { return high - low; }

  friend bool operator==(const PowerRun&, const PowerRun&) = default;
};

/// The same figures that the report gives of these outcomes; of orders that are drawn by the
/// study's rule p comes from 999 drawings.
/// \param with_attainable  of studies under the null hypothesis
[[nodiscard]] PowerRun judged(const PrimaryTest& test, const analysis::Outcomes& outcomes,
                              bool with_attainable);

/// Whether the test decides.
[[nodiscard]] bool is_significant(const PowerRun& run) noexcept;

}  // namespace touchtrial::planning
