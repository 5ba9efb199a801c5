/// \file A mean over participants who come in strata, such as the stations of a study. Source:
/// docs/statistics.md, "Stations as strata"; Paule, Mandel 1982; IntHout, Ioannidis, Borm 2014.
#pragma once

#include "analysis/statistics/proportion.hpp"

#include <optional>
#include <span>
#include <vector>

namespace touchtrial::analysis {

/// With fewer, the spread between strata cannot be estimated.
inline constexpr int kMinRandomStrata = 6;

/// The strata as a sample of others.
struct RandomStrata {
  double mean = 0.0;    ///< of strata, each weighing by its variance and the spread
  Interval interval;    ///< t with one degree fewer than strata
  double spread = 0.0;  ///< standard deviation of the strata's own means
};

struct StratifiedMean {
  int strata = 0;
  double mean = 0.0;  ///< of all values, so that a stratum weighs by its participants
  /// For the strata as they are: t from the spread within them, with as many degrees as values less
  /// strata; nothing without degrees, or if all are alike within their strata.
  std::optional<Interval> interval{};
  std::optional<RandomStrata> random{};  ///< from kMinRandomStrata on
};

/// \param strata  one number per participant; empty strata are left out
/// \param range  of all possible values; intervals are cut to it
/// \param level  in (0, 1)
/// \return nothing with fewer than two strata
/// \throws std::invalid_argument if the level is not in (0, 1), or a value is not finite
[[nodiscard]] std::optional<StratifiedMean> stratified_mean(
    std::span<const std::vector<double>> strata, Interval range = {0.0, 1.0},
    double level = kConfidenceLevel);

}  // namespace touchtrial::analysis
