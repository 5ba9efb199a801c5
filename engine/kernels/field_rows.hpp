/// \file Rows of what is made from a texture in single precision: its picture, its force, and the
/// copy to memory that is not needed again soon. Vectorised for every target.
#pragma once

#include "engine/kernels/streamed_row.hpp"

#include <cstdint>

namespace touchtrial::engine {

/// clamp(floor(128 + T + 0.5), 0, 255), exactly, for any floats; NaN gives 0.
/// \param width  >= 0; no more than this many samples are read or written
void picture_row(const float* texture, int width, std::uint8_t* picture);

/// How a row of a surface falls from left to right, and what its columns weigh in the fall from row
/// to row: G(x - 1) - G(x + 1) and G(x) + (G(x - 1) + G(x + 1)) / 2.
struct SlopeRow {
  float* across = nullptr;
  float* weight = nullptr;
};

/// Takes a row of a surface and gives the tangential force of the row above it, 3 x 3 neighbours:
/// x = across + (across above + across below) / 2, y = weight above - weight below.
/// \param surface  `width` samples, and a zero before and behind them
/// \param above,centre  slopes of the two rows above the surface
/// \param below  receives the slopes of the surface; a vector behind them may be overwritten
/// \param force_x,force_y  receive `width` samples and no more
/// \param beside  a row of at most `width` samples that is moved meanwhile
void force_row(const float* surface, int width, const SlopeRow& above, const SlopeRow& centre,
               const SlopeRow& below, float* force_x, float* force_y, const StreamedRow& beside);

/// Moves all of a row past the caches.
void move_row(const StreamedRow& row);

}  // namespace touchtrial::engine
