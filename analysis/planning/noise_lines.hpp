/// \file The supports of prototypes along a line of noise, and which of them is the largest where.
#pragma once

#include "analysis/planning/radial_distribution.hpp"

#include <span>

namespace touchtrial::planning {

/// Adds to `answers`, by picture, the probability that its support is the largest when the noise t
/// along a line has the given distribution: prototype k's support is at[k] + t * slope[k], and
/// that of a picture the largest of its prototypes'. Equal ones share. If `slopes` is not empty it
/// gets, [answer x pictures + picture], the derivatives by what is added to a picture's support.
/// \param picture  of each prototype
/// \param weight  of this line
void add_winners(std::span<const double> at, std::span<const double> slope,
                 std::span<const int> picture, const RadialDistribution& noise, double weight,
                 std::span<double> answers, std::span<double> slopes) noexcept;

}  // namespace touchtrial::planning
