/// \file Helpers of several statistics: argument checks, rounding, and the p of random draws.
#pragma once

#include "analysis/statistics/proportion.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string>

namespace touchtrial::analysis {

/// \throws std::invalid_argument if a confidence level is not in (0, 1)
inline void require_level(double level) {
  if (!(level > 0.0 && level < 1.0)) {
    throw std::invalid_argument("a confidence level must be in (0, 1)");
  }
}

/// \throws std::invalid_argument if not 0 <= correct <= n
inline void require_possible(const Proportion& proportion) {
  if (proportion.correct < 0 || proportion.correct > proportion.n) {
    throw std::invalid_argument("a proportion needs 0 <= correct <= n");
  }
}

/// \param what  the computation, which begins the message
/// \throws std::invalid_argument if a value is not finite
inline void require_finite(std::span<const double> values, const char* what) {
  if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); })) {
    throw std::invalid_argument(std::string(what) + " needs finite values");
  }
}

/// Removes rounding errors of sums whose true value is 0.
/// \return 0 if the number is nearer to 0 than 1e-12, otherwise the number
[[nodiscard]] inline double without_noise(double number) noexcept {
  constexpr double kNoise = 1e-12;
  return std::abs(number) < kNoise ? 0.0 : number;
}

/// The p of a test by random draws, never 0. Source: Phipson, Smyth 2010.
/// \param as_extreme  the number of draws at least as extreme as the observation
[[nodiscard]] inline double p_of_draws(double as_extreme, double draws) noexcept {
  return (as_extreme + 1.0) / (draws + 1.0);
}

}  // namespace touchtrial::analysis
