/// \file Rows of what is made from a texture in single precision: its picture, its force, and the
/// copy to memory that is not needed again soon. Vectorised for every target.
#pragma once

#include <cstdint>

namespace touchtrial {

/// clamp(floor(128 + T + 0.5), 0, 255), exactly, for any floats; NaN gives 0.
/// \param width  >= 0; no more than this many samples are read or written
void picture_row(const float* texture, int width, std::uint8_t* picture);

/// Three neighbouring rows of a surface; above the first and below the last row there is nothing.
struct SurfaceRows {
  const float* above = nullptr;  ///< may be null
  const float* centre = nullptr;
  const float* below = nullptr;  ///< may be null
};

/// The tangential force of the neighbourhood of 3 x 3: only neighbours that exist count. Source:
/// docs/method.md, "Force field".
/// \param width  >= 1; no more than this many samples are read or written
void force_row(const SurfaceRows& rows, int width, float* force_x, float* force_y);

/// Copies past the caches. \pre finish_streams() before another thread reads `to`
void stream_row(const float* from, int width, float* to);
void finish_streams();

}  // namespace touchtrial
