/// \file Draws the tangential force as arrows on its texture (paper Fig. 4).
#pragma once

#include "core/plane.hpp"
#include "engine/force_field.hpp"
#include "engine/pictures/colour_image.hpp"

#include <filesystem>

namespace touchtrial::engine {

/// The side of the enlarged patch in pixels; smaller textures are enlarged whole.
inline constexpr int kArrowPatchSide_px = 24;

/// The part of a texture whose forces are drawn.
struct ArrowPatch {
  int y = 0;  ///< first row, pixels
  int x = 0;  ///< first column, pixels
  int height = 0;
  int width = 0;
  /// The force whose arrow is as long as one texture pixel, in grey levels per pixel; 0 if there is
  /// no force.
  double force_of_unit_arrow = 0.0;
};

/// The patch with the largest sum of squared forces, the first if several are equal; the middle of
/// the texture if there is no force.
/// \throws std::invalid_argument if the field is empty
[[nodiscard]] ArrowPatch strongest_patch(const ForceField<double>& force);

/// A patch of a texture, enlarged to fill a square, with an arrow for the force at each pixel. A
/// patch that is not square is centred on white. Arrows are centred on their pixels, with lengths
/// proportional to the force.
/// \param texture  8-bit picture of the same shape as the field, at least 1 x 1
/// \param patch  within the texture
/// \param side_px  of the square, >= 1
/// \throws std::invalid_argument if the shapes differ, the patch is not within them, or side_px is
///   below 1
[[nodiscard]] ColourImage force_arrows(const GreyImage& texture, const ForceField<double>& force,
                                       const ArrowPatch& patch, int side_px);

/// Writes a PNG of two parts: the whole texture with a frame around the strongest patch, and that
/// patch as force_arrows() draws it.
/// \param texture  8-bit picture of the same shape as the field, at least 1 x 1
/// \return the patch
/// \throws std::invalid_argument if the shapes differ or are empty
/// \throws as write_output
ArrowPatch write_force_arrows(const std::filesystem::path& path, const GreyImage& texture,
                              const ForceField<double>& force);

}  // namespace touchtrial::engine
