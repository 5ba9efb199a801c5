/// \file How far an output is from the same in double, where that can be asked.
#pragma once

#include "core/plane.hpp"
#include "tests/engine/plane_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace touchtrial::bench {

/// The largest |a - b| of the samples at least `border` samples away from the edge; infinite if the
/// shapes differ or a sample is not a number. \param counts  called with a sample's place (y, x);
/// false leaves it out
template <typename A, typename B, typename Counts>
[[nodiscard]] double largest_difference(const Plane<A>& a, const Plane<B>& b, int border,
                                        Counts counts) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (a.height() != b.height() || a.width() != b.width()) return kInfinity;
  double largest = 0.0;
  for (int y = border; y < a.height() - border; ++y) {
    for (int x = border; x < a.width() - border; ++x) {
      if (!counts(y, x)) continue;
      const double difference =
          std::abs(static_cast<double>(a.at(y, x)) - static_cast<double>(b.at(y, x)));
      if (std::isnan(difference)) return kInfinity;
      largest = std::max(largest, difference);
    }
  }
  return largest;
}

}  // namespace touchtrial::bench
