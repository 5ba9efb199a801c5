/// \file The adaptive method (two passes over the image) and the fixed method (one pass) in single
/// precision.
///
/// The first pass computes sub-bands, gradients and the maximum of CSGV in rolling rows. The second
/// computes orders, texture and, if requested, the picture. In between, the texture's plane stores
/// CSGV. Besides the planes, the methods use memory for some rows, depending on the radius.
#pragma once

#include "engine/extraction.hpp"

namespace touchtrial::engine {

/// The adaptive method with default options except for the radius.
/// \param image  not empty
/// \param radius  1 .. ExtractionOptions::kMaxRadius
/// \param result  receives the requested planes except `enhanced`; the others are emptied. Planes
///   of the right shape are reused.
/// Thread-safe.
void extract_adaptive(const GreyImage& image, int radius, const RequestedPlanes& requested,
                      Extraction<float>& result);

/// The fixed method with the additive norm.
/// \param order  v in [0, 1)
void extract_fixed(const GreyImage& image, int radius, double order,
                   const RequestedPlanes& requested, Extraction<float>& result);

/// Computes only the sub-band planes of `result`.
void extract_sub_bands(const GreyImage& image, Extraction<float>& result);

}  // namespace touchtrial::engine
