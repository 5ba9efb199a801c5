/// \file The TV-Gabor texture that all solvers go towards.
#pragma once

#include "core/plane.hpp"

namespace touchtrial::bench {

/// v of the default options after hundreds of steps in double. Kept until another image is asked
/// for. \param image  not flat
[[nodiscard]] const Plane<double>& tv_gabor_truth(const GreyImage& image);

}  // namespace touchtrial::bench
