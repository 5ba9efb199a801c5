/// \file The adaptive and the fixed method in single precision: two passes over the image, or one.
///
/// Pass one makes sub-bands, gradients and the maximum of CSGV, in rolling rows; pass two orders,
/// texture, and picture and force where they are wanted. Beside the planes asked for, memory is one
/// byte a pixel for CSGV (adaptive) and a number of rows that the radius decides.
#pragma once

#include "engine/extraction.hpp"

namespace touchtrial::engine {

/// \param image  not empty  \param radius  1 .. ExtractionOptions::kMaxRadius
/// \param result  receives all planes wanted but `enhanced`; others are emptied. Planes that have
///   the right shape are used again.
/// Thread-safe.
void extract_adaptive(const GreyImage& image, int radius, const WantedPlanes& wanted,
                      Extraction<float>& result);

/// \param order  v in [0, 1)
void extract_fixed(const GreyImage& image, int radius, double order, const WantedPlanes& wanted,
                   Extraction<float>& result);

/// The sub-bands alone: those planes of `result`.
void extract_sub_bands(const GreyImage& image, Extraction<float>& result);

}  // namespace touchtrial::engine
