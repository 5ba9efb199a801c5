/// \file Grey-level co-occurrence statistics of a picture.
/// Source: docs/method.md, "Metrics" (Haralick's statistics; paper Table 1).
#pragma once

#include "core/plane.hpp"

#include <array>

namespace touchtrial::engine {

/// Statistics of the matrix p(i, j), the share of neighbours that have the levels i and j, in
/// either order.
struct GlcmStatistics {
  double angular_second_moment;  ///< sum of p^2, in (0, 1]; 1 for a flat image
  double energy;       ///< square root of the above; called entropy in the paper's Table 1
  double entropy;      ///< -sum of p ln p, in nats; 0 for a flat image
  double contrast;     ///< sum of (i - j)^2 p, in squared grey levels
  double correlation;  ///< of i and j, in [-1, 1]; 1 if they do not vary
};

/// The offset from a pixel (y, x) to its neighbour (y + dy, x + dx); y points downwards.
struct GlcmOffset {
  int degrees;
  int dy;
  int dx;
};

/// The directions of GlcmTable: right, up right, up, up left.
inline constexpr std::array<GlcmOffset, 4> kGlcmOffsets = {
    {{0, 0, 1}, {45, -1, 1}, {90, -1, 0}, {135, -1, -1}}};

/// One entry for each of kGlcmOffsets.
using GlcmTable = std::array<GlcmStatistics, 4>;

/// Computes the statistics of the symmetric matrix of 256 levels from pairs inside the image.
/// Counts are exact; statistics are in double.
/// \param image  at least 2 x 2, so that every direction has a pair; below 2^32 pixels
/// \throws std::invalid_argument for any other size
/// Thread-safe. Needs 1 MB while it runs.
[[nodiscard]] GlcmTable glcm_statistics(const GreyImage& image);

}  // namespace touchtrial::engine
