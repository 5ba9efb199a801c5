/// \file Structural similarity, slow and literal: every window's weighted moments by direct sums
/// about its means, and l, c and s by their definitions.
#pragma once

#include "core/plane.hpp"

#include <array>

namespace touchtrial::reference {

/// Means over all windows.
struct Similarity {
  double l;
  double cs;
  double lcs;
};

[[nodiscard]] Similarity similarity(const Plane<double>& a, const Plane<double>& b);

struct MsSsim {
  double unit;
  double wang;
};

[[nodiscard]] MsSsim ms_ssim(const GreyImage& a, const GreyImage& b);

/// The 11 x 11 window, sum 1.
[[nodiscard]] std::array<std::array<double, 11>, 11> ssim_window();

}  // namespace touchtrial::reference
