/// \file What sums of proportions leave of rounding where the true figure is 0.
#pragma once

#include <cmath>

namespace touchtrial::analysis {

/// \return 0 for a figure nearer to it than 1e-12, else the figure
[[nodiscard]] inline double without_noise(double figure) noexcept {
  constexpr double kNoise = 1e-12;
  return std::abs(figure) < kNoise ? 0.0 : figure;
}

}  // namespace touchtrial::analysis
