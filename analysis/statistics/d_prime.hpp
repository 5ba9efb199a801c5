/// \file Nominal sensitivity of an m-alternative choice: what d' an unbiased observer of m equally
/// distant alternatives needs for a proportion correct. Source: docs/statistics.md, "d'";
/// Green, Swets 1966; Hacker, Ratcliff 1979.
#pragma once

#include "analysis/statistics/proportion.hpp"

#include <optional>

namespace touchtrial::analysis {

/// Integral over z of phi(z - d) Phi(z)^(m - 1).
/// \param alternatives  >= 2
/// \return 0 .. 1; error below 1e-10
/// \throws std::invalid_argument if d is not finite or alternatives < 2
[[nodiscard]] double proportion_correct_of(double d_prime, int alternatives);

/// A nominal d'. Never infinite: where nothing or everything is correct there is a bound instead.
struct DPrime {
  std::optional<double> estimate;  ///< nothing at 0 % and 100 %
  std::optional<double> low;       ///< of the Clopper-Pearson interval's lower end; nothing at 0
  std::optional<double> high;      ///< of its upper end; nothing at 1
};

/// \throws std::invalid_argument if alternatives < 2 or the proportion is impossible
[[nodiscard]] DPrime d_prime(Proportion proportion, int alternatives,
                             double level = kConfidenceLevel);

}  // namespace touchtrial::analysis
