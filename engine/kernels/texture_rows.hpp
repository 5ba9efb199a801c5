/// \file Rows of the picture of a texture, and copies past the caches, vectorised for every target.
#pragma once

#include "engine/kernels/streamed_row.hpp"

#include <cstdint>

namespace touchtrial::engine {

/// clamp(floor(128 + T + 0.5), 0, 255), exactly, for any floats; NaN gives 0.
/// \param width  >= 0; no more than this many samples are read or written
void picture_row(const float* texture, int width, std::uint8_t* picture);

/// Moves a whole row past the caches.
void move_row(const StreamedRow& row);

}  // namespace touchtrial::engine
