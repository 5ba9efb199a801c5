/// \file A texture as the stylus meets it: the filtered surface and its tangential force, on a
/// plane.
#pragma once

#include "core/plane.hpp"
#include "core/plane_geometry.hpp"
#include "engine/rendering/rendering_options.hpp"

#include <span>
#include <utility>

namespace touchtrial {

/// One pixel of a field, before gains.
struct FieldSample {
  float surface = 128.0F;  ///< G after the reconstruction filter, grey levels
  float force_x = 0.0F;    ///< tangential force, grey levels per pixel, to the right
  float force_y = 0.0F;    ///< the same, downwards in the image
};

/// A field that somebody else owns (a mapped file of a pack, or a TextureField). It holds no name.
struct FieldView {
  PlaneGeometry geometry;
  std::span<const FieldSample> samples;  ///< row-major, geometry.height_px x geometry.width_px
};

/// A field in memory.
class TextureField {
 public:
  TextureField(PlaneGeometry geometry, Plane<FieldSample> samples)
      : geometry_(geometry), samples_(std::move(samples)) {}

  [[nodiscard]] FieldView view() const noexcept { return {geometry_, samples_.samples()}; }

 private:
  PlaneGeometry geometry_;
  Plane<FieldSample> samples_;
};

/// Builds a field from an extracted texture T: surface 128 + T, reconstruction filter, tangential
/// force with the options' neighbourhood. Computed in double, stored as float.
/// \param texture  T, grey levels, finite, at least 1 x 1
/// \throws std::invalid_argument if the texture is empty or not finite, or pitch, filter or
/// neighbourhood is out
///   of range
/// Thread-safe.
[[nodiscard]] TextureField make_texture_field(const Plane<double>& texture,
                                              const RenderingOptions& options);

}  // namespace touchtrial
