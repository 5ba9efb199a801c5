/// \file The adaptive and the fixed method in single precision, in two passes over the image or
/// one.
///
/// The first pass computes sub-bands, gradients and the maximum of CSGV in rolling rows. The second
/// computes orders and texture, and the picture if it is wanted. CSGV waits in the texture's plane
/// in between. Besides the planes they need memory for rows whose number depends on the radius.
#pragma once

#include "engine/extraction.hpp"

namespace touchtrial::engine {

/// The adaptive method with its default options but the radius.
/// \param image  not empty
/// \param radius  1 .. ExtractionOptions::kMaxRadius
/// \param result  receives the wanted planes but `enhanced`; the others are emptied. Planes that
///   have the right shape are reused.
/// Thread-safe.
void extract_adaptive(const GreyImage& image, int radius, const WantedPlanes& wanted,
                      Extraction<float>& result);

/// The fixed method with the additive norm.
/// \param order  v in [0, 1)
void extract_fixed(const GreyImage& image, int radius, double order, const WantedPlanes& wanted,
                   Extraction<float>& result);

/// Computes only the sub-bands, into those planes of `result`.
void extract_sub_bands(const GreyImage& image, Extraction<float>& result);

}  // namespace touchtrial::engine
