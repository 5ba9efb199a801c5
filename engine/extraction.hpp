/// \file Extracts the texture of an image by any method. This is the main entry point of the
/// engine. Source: docs/method.md.
#pragma once

#include "core/plane.hpp"
#include "engine/extraction_options.hpp"
#include "engine/force_field.hpp"

#include <vector>

namespace touchtrial::engine {

/// The by-products to keep. Unneeded stages are not computed.
struct RequestedPlanes {
  bool sub_bands = false;
  bool csgv = false;
  bool order = false;
  bool enhanced = false;
  bool cartoon = false;
  bool picture = false;
  bool force = false;

  [[nodiscard]] static RequestedPlanes all() { return {true, true, true, true, true, true, true}; }
};

/// The result of an extraction. Planes that were not requested, or that the method does not have,
/// are empty (0 x 0). All planes but the sub-bands have the image's shape.
template <typename Real>
struct Extraction {
  /// T in grey levels, 0 where the image is flat; v for tv-gabor. With a control, texture, picture,
  /// force and enhanced belong to the control, the other planes to the method.
  Plane<Real> texture;
  /// The sub-bands of the first level; ceil(H/2) x ceil(W/2). The first letter is the filter along
  /// x (adaptive).
  Plane<Real> sub_band_ll, sub_band_lh, sub_band_hl, sub_band_hh;
  Plane<Real> csgv;      ///< composite sub-band gradient, >= 0 (adaptive)
  Plane<Real> order;     ///< v in [0, 1), the same everywhere for fixed (adaptive, fixed)
  Plane<Real> enhanced;  ///< image + T (every method)
  Plane<Real> cartoon;   ///< u = image - v (tv-gabor)
  GreyImage picture;     ///< texture_picture() with its default mapping (every method)
  /// tangential_force() of the texture with 3 x 3 neighbours. Adding 128 to T would not change it
  /// (every method).
  ForceField<Real> force;
  /// The components used; none if the image is flat (tv-gabor).
  std::vector<GaborComponent> components;
  double gap = 0.0;       ///< the relative gap reached (tv-gabor)
  int steps = 0;          ///< the iterations used (tv-gabor)
  bool converged = true;  ///< false if tv-gabor stopped at max_steps
};

/// Extracts the texture of an image. Real is float or double: the precision of the planes. A float
/// texture is within 4e-5 grey levels of the double texture (adaptive and fixed with the additive
/// norm), or equals the double texture rounded (other norms and methods, except tv-gabor).
/// \param image  8-bit grey, at least 1 x 1
/// \throws std::invalid_argument if the image is empty, if a parameter is out of range or NaN, or
/// if tv-gabor chooses its component automatically and a side of the image is below 3 pixels
/// Thread-safe. tv-gabor stopping at max_steps is not an error: see Extraction::converged.
template <typename Real>
[[nodiscard]] Extraction<Real> extract_texture(const GreyImage& image,
                                               const ExtractionOptions& options,
                                               const RequestedPlanes& requested = {});

/// Extracts into an existing result. In float, the adaptive and fixed methods with default norm,
/// gradient, combine and levels reuse planes of the right shape, so a series of images of one size
/// allocates almost nothing.
template <typename Real>
void extract_texture_into(const GreyImage& image, const ExtractionOptions& options,
                          const RequestedPlanes& requested, Extraction<Real>& result);

/// Replaces a method's texture by the control stimulus that the options request, if any.
template <typename Real>
void apply_control(const ExtractionOptions& options, Plane<Real>& texture);

/// The texture as an 8-bit picture, rounded half up and limited to 0 .. 255.
/// \throws std::invalid_argument if the texture is empty or not finite
template <typename Real>
[[nodiscard]] GreyImage texture_picture(const Plane<Real>& texture,
                                        Mapping mapping = Mapping::offset);

}  // namespace touchtrial::engine
