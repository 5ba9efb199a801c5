/// \file How many times better the odds of a right answer are with one method than with another.
/// Source: docs/statistics.md, "Odds ratio"; Mantel, Haenszel 1959; Robins, Breslow, Greenland
/// 1986.
#pragma once

#include "analysis/statistics/proportion.hpp"

#include <optional>
#include <span>
#include <utility>

namespace touchtrial::analysis {

struct OddsRatio {
  double estimate = 1.0;
  Interval interval;  ///< of Robins, Breslow and Greenland
};

/// Mantel and Haenszel's common odds ratio over participants: each is a stratum of first and second
/// method's trials.
/// \return nothing if it is 0 or infinite (one of the methods is all right or all wrong in every
///   participant who tells)
/// \throws std::invalid_argument if a proportion is impossible, or the level is not in (0, 1)
[[nodiscard]] std::optional<OddsRatio> mantel_haenszel(
    std::span<const std::pair<Proportion, Proportion>> participants,
    double level = kConfidenceLevel);

}  // namespace touchtrial::analysis
