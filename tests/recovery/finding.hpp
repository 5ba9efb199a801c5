/// \file One line of the table: a quantity that is known, and what the analysis found of it.
#pragma once

#include "core/random.hpp"

#include <functional>
#include <string>
#include <vector>

namespace touchtrial::recovery {

/// What a share or a mean over many made-up studies came to.
struct Finding {
  std::string group;       ///< "coverage", "type-I error", "bias", "recovered"
  std::string what;        ///< the statistic
  std::string population;  ///< whose studies
  double nominal = 0.0;    ///< what it should be
  double found = 0.0;
  double monte_carlo = 0.0;  ///< standard error of `found`
  /// Range that `found` must lie in but for Monte-Carlo error; nominal to nominal where exact.
  double least = 0.0;
  double most = 0.0;
  std::string why{};  ///< why the range is not the nominal figure alone

  /// Within 4 Monte-Carlo standard errors of its range.
  [[nodiscard]] bool holds() const noexcept;
};

/// Runs `study` once for each repetition, on all cores, each with random numbers of its own, and
/// averages what it returns: shares of ones and zeros, or any figure. A function of its arguments.
struct Average {
  double mean = 0.0;
  double standard_error = 0.0;
};
[[nodiscard]] Average average_of(int repetitions, const std::string& purpose,
                                 const std::function<double(RandomStream&)>& study);

/// All lines. \param repetitions  made-up studies for each, >= 100
[[nodiscard]] std::vector<Finding> coverage_findings(int repetitions);
[[nodiscard]] std::vector<Finding> error_findings(int repetitions);
[[nodiscard]] std::vector<Finding> estimate_findings(int repetitions);

}  // namespace touchtrial::recovery
