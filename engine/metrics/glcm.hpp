/// \file Grey-level co-occurrence statistics of a picture.
/// Source: docs/method.md, "Metrics" (Haralick's statistics; paper Table 1).
#pragma once

#include "core/plane.hpp"

#include <array>

namespace touchtrial::engine {

/// Statistics of the matrix p(i, j): how often levels i and j are neighbours, in either order.
struct GlcmStatistics {
  double angular_second_moment;  ///< sum of p^2, in (0, 1]; 1 for a flat image
  double energy;                 ///< its square root: what the paper's Table 1 calls entropy
  double entropy;                ///< -sum of p ln p, in nats; 0 for a flat image
  double contrast;               ///< sum of (i - j)^2 p, in squared grey levels
  double correlation;            ///< of i and j, in [-1, 1]; 1 where they do not vary
};

/// Where the neighbour of a pixel lies, y downwards: (y, x) + (dy, dx).
struct GlcmOffset {
  int degrees;
  int dy;
  int dx;
};

/// The directions of GlcmTable: one step right, right and up, up, left and up.
inline constexpr std::array<GlcmOffset, 4> kGlcmOffsets = {
    {{0, 0, 1}, {45, -1, 1}, {90, -1, 0}, {135, -1, -1}}};

/// One entry for each of kGlcmOffsets.
using GlcmTable = std::array<GlcmStatistics, 4>;

/// 256 levels, symmetric, pairs inside the image only. The counts are exact; the statistics are
/// computed from them in double.
/// \param image  at least 2 x 2, so that every direction has a pair; below 2^32 pixels
/// \throws std::invalid_argument for another size
/// Thread-safe. Needs 1 MB while it runs.
[[nodiscard]] GlcmTable glcm_statistics(const GreyImage& image);

}  // namespace touchtrial::engine
