/// \file A mean over participants in strata, such as the stations of a study. Source:
/// docs/statistics.md, "Stations as strata"; Paule, Mandel 1982; IntHout, Ioannidis, Borm 2014.
#pragma once

#include "analysis/statistics/proportion.hpp"

#include <optional>
#include <span>
#include <vector>

namespace touchtrial::analysis {

/// With fewer strata, the spread between them cannot be estimated.
inline constexpr int kMinRandomStrata = 6;

/// The random-effects estimate, which treats strata as a sample from a population of strata.
struct RandomStrata {
  double mean = 0.0;    ///< over strata, weighted by inverse variance including the spread
  Interval interval;    ///< Student's t with strata - 1 degrees of freedom
  double spread = 0.0;  ///< standard deviation of the true means of strata
};

struct StratifiedMean {
  int strata = 0;
  double mean = 0.0;  ///< over all participants, regardless of stratum
  /// For these strata only (fixed effects): Student's t from the spread within strata, with n -
  /// strata degrees of freedom. Nothing without degrees of freedom, or if values do not vary within
  /// strata.
  std::optional<Interval> interval{};
  std::optional<RandomStrata> random{};  ///< only with at least kMinRandomStrata strata
};

/// \param strata  one number per participant; empty strata are left out
/// \param range  of all possible values; intervals are clipped to it
/// \param level  in (0, 1)
/// \return nothing with fewer than two strata
/// \throws std::invalid_argument if the level is not in (0, 1), or a value is not finite
[[nodiscard]] std::optional<StratifiedMean> stratified_mean(
    std::span<const std::vector<double>> strata, Interval range = {0.0, 1.0},
    double level = kConfidenceLevel);

}  // namespace touchtrial::analysis
