/// \file The tangential force as arrows on the texture it comes from (paper Fig. 4).
#pragma once

#include "core/plane.hpp"
#include "engine/force_field.hpp"
#include "engine/pictures/colour_image.hpp"

#include <filesystem>

namespace touchtrial::engine {

/// Side of the patch that is enlarged, pixels; less where the texture is smaller.
inline constexpr int kArrowPatchSide_px = 24;

/// The part of a texture whose forces are drawn.
struct ArrowPatch {
  int y = 0;  ///< of its first row, pixels
  int x = 0;
  int height = 0;
  int width = 0;
  /// Grey levels per pixel of an arrow as long as a pixel of the texture is wide; 0 if there is no
  /// force.
  double force_of_unit_arrow = 0.0;
};

/// The patch in which the sum of the squared forces is largest, the first of several; the middle if
/// there is no force.
/// \throws std::invalid_argument if the field is empty
[[nodiscard]] ArrowPatch strongest_patch(const ForceField<double>& force);

/// A patch of a texture enlarged to fill a square, centred on white if it is none, with an arrow in
/// the direction of the force at each pixel. Arrows have their middle at the centres of their
/// pixels; their length is proportional to the force.
/// \param texture  8-bit picture of the same shape as the field, at least 1 x 1
/// \param patch  within the texture
/// \param side_px  of the square, >= 1
/// \throws std::invalid_argument if the shapes differ, or the patch is not within them
[[nodiscard]] ColourImage force_arrows(const GreyImage& texture, const ForceField<double>& force,
                                       const ArrowPatch& patch, int side_px);

/// Writes a PNG of two parts: the whole texture with a frame round the strongest patch, and that
/// patch as by force_arrows.
/// \param texture  8-bit picture of the same shape as the field, at least 1 x 1
/// \return the patch
/// \throws std::invalid_argument if the shapes differ or are empty
/// \throws FileError if the file cannot be written
ArrowPatch write_force_arrows(const std::filesystem::path& path, const GreyImage& texture,
                              const ForceField<double>& force);

}  // namespace touchtrial::engine
