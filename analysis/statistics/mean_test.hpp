/// \file Student's test of a mean over participants. Sources: docs/statistics.md, "The registered
/// question"; Student 1908.
#pragma once

#include <optional>
#include <span>

namespace touchtrial::analysis {

/// Which means count against the null hypothesis: larger ones alone, or those on both sides.
enum class Sides { one, two };

/// The one-sample t test of a mean over participants. If `all_alike`, t does not exist; p is then
/// that of flipping the signs of their distances from `null`: 2^-n or 2 * 2^-n, or 1 if they are
/// `null` itself or, one-sided, lie below it. Whoever shows it must not call it a t test.
/// \param values  one number per participant
/// \param null  the mean under the null hypothesis
/// \return p in [0, 1]; nothing with fewer than two values
/// \throws std::invalid_argument if a value or `null` is not finite
[[nodiscard]] std::optional<double> t_test_p(std::span<const double> values, double null,
                                             Sides sides);

}  // namespace touchtrial::analysis
