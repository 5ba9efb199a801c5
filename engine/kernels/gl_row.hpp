/// \file One row of Gruenwald-Letnikov texture in single precision, vectorised for every target.
///
/// With W_k the sum of the three samples of a column that lie k above, in, and k below the row,
///   8 D_k(x) = 9 I(x) - W_k(x - k) - W_k(x) - W_k(x + k),
/// all of it exact in 16 bits. Then T = v/8 (8 D_1 + a_2 (8 D_2 + a_3 (8 D_3 + ..))), with
/// a_k = (k - 1 - v) / k: two fused operations a ring, and an error that does not grow with K.
#pragma once

#include "engine/kernels/extended_rows.hpp"
#include "engine/kernels/streamed_row.hpp"

#include <span>

namespace touchtrial::engine {

/// The largest radius that the kernel has room for.
inline constexpr int kMaxGlRadius = 63;

/// \param rows  reach >= radius  \param radius  1 .. kMaxGlRadius
/// \param orders  v in [0, 1) for each pixel; read up to a vector past the row's end
/// \param texture  receives width() samples and no more
/// \param beside  rows of at most width() samples that are moved meanwhile
void gl_row(const ExtendedRows& rows, int radius, const float* orders, float* texture,
            std::span<const StreamedRow> beside = {});

/// The same with one order for all pixels.
void gl_row(const ExtendedRows& rows, int radius, double order, float* texture,
            std::span<const StreamedRow> beside = {});

}  // namespace touchtrial::engine
