/// \file Nominal sensitivity in an m-alternative choice: the d' with which an unbiased observer of
/// m equally distant alternatives reaches a proportion correct. Source: docs/statistics.md, "d'";
/// Green, Swets 1966; Hacker, Ratcliff 1979.
#pragma once

#include "analysis/statistics/proportion.hpp"

#include <optional>

namespace touchtrial::analysis {

/// The integral over z of phi(z - d) Phi(z)^(m - 1).
/// \param alternatives  >= 2
/// \return 0 .. 1; error below 1e-10
/// \throws std::invalid_argument if d is not finite or alternatives < 2
[[nodiscard]] double proportion_correct_of(double d_prime, int alternatives);

/// A nominal d'. Where nothing or everything is correct, a bound replaces the infinite estimate.
struct DPrime {
  std::optional<double> estimate;  ///< nothing at 0 % and 100 %
  std::optional<double> low;       ///< at the share's lower limit; nothing if that is 0
  std::optional<double> high;      ///< at its upper limit; nothing if that is 1
};

/// \param limits  an interval of the share: the d' at its ends is an interval of d', of the same
///   coverage
/// \throws std::invalid_argument if alternatives < 2, or the proportion or a limit is impossible
[[nodiscard]] DPrime d_prime(Proportion proportion, int alternatives, const Interval& limits);

/// With the limits of Clopper and Pearson's interval, for independent trials.
/// \throws std::invalid_argument if alternatives < 2 or the proportion is impossible
[[nodiscard]] DPrime d_prime(Proportion proportion, int alternatives,
                             double level = kConfidenceLevel);

}  // namespace touchtrial::analysis
