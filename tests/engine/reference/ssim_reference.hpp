/// \file Structural similarity, slow and literal: every window's weighted moments by direct sums
/// about its means, and l, c and s by their definitions.
#pragma once

#include "core/plane.hpp"

namespace touchtrial::reference {

struct MsSsim {
  double unit;
  double wang;
};

[[nodiscard]] MsSsim ms_ssim(const GreyImage& a, const GreyImage& b);

}  // namespace touchtrial::reference
