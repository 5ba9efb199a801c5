/// \file Co-occurrence statistics, slow and literal: the normalised matrix of one direction, pair
/// by pair, and each statistic as its own double loop.
#pragma once

#include "core/plane.hpp"
#include "engine/metrics/glcm.hpp"

namespace touchtrial::reference {

[[nodiscard]] engine::GlcmStatistics glcm_statistics(const GreyImage& image, int dy, int dx);

}  // namespace touchtrial::reference
