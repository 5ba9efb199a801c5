/// \file A texture on the virtual plane, prepared for a rendering model.
#pragma once

#include "core/plane.hpp"
#include "core/plane_geometry.hpp"
#include "engine/rendering/rendering_options.hpp"

#include <limits>
#include <span>
#include <utility>

namespace touchtrial::engine {

/// A field owned by another object: a mapped file of a pack, or a TextureField. Has one plane of
/// heights, from which forces are computed at the stylus; none for a flat wall.
struct FieldView {
  PlaneGeometry geometry;
  ModelKind model = ModelKind::paper;  ///< the model that can render the field
  /// `paper`: T after the reconstruction filter. `surface`: coefficients of the cubic B-spline
  /// through it. Grey levels, row-major, geometry.height_px x geometry.width_px.
  std::span<const float> heights = {};
  /// `paper`: the heights for the tangential force if they differ from `heights`, as in a sum of
  /// fields with different gains. Same size as `heights`, or empty.
  std::span<const float> slope_heights = {};
  int neighbourhood = 3;  ///< `paper`: side of the tangential force's neighbourhood, pixels
  /// Upper bound of `heights`. Models do not read the field above it. Infinite if unknown.
  double highest = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool empty() const noexcept { return heights.empty(); }
  /// The heights for the tangential force.
  [[nodiscard]] std::span<const float> slopes() const noexcept {
    return slope_heights.empty() ? heights : slope_heights;
  }
};

/// The largest height of a field; not finite if any height is not. Reads the entire field.
/// \pre the field is not empty
[[nodiscard]] double highest_of(FieldView field);

/// A field in memory.
class TextureField {
 public:
  /// \param properties  geometry, model and neighbourhood of the field; spans are ignored
  /// \param heights,slope_heights  as in FieldView
  explicit TextureField(const FieldView& properties, Plane<float> heights,
                        Plane<float> slope_heights = {});

  [[nodiscard]] FieldView view() const noexcept {
    FieldView view = properties_;
    view.heights = heights_.samples();
    view.slope_heights = slope_heights_.samples();
    return view;
  }

 private:
  FieldView properties_;  ///< without spans
  Plane<float> heights_;
  Plane<float> slope_heights_;
};

/// A field with gains, for sum_with_gains.
struct FieldWithGains {
  FieldView field;
  Gains gains;
};

/// The sum of fields multiplied by their gains, minus its mean height, so that a textured wall has
/// the position of a flat one. Render it with gains of 1 and a reference of 128. Thread-safe.
/// \param parts  with the same geometry and model
/// \throws std::invalid_argument if there are none, or they differ
[[nodiscard]] TextureField sum_with_gains(std::span<const FieldWithGains> parts);

/// Root mean square of a field's lateral force or slope, in units of height per pixel.
[[nodiscard]] double lateral_rms(FieldView field);

/// Builds a field for the options' model from an extracted texture T: T after the reconstruction
/// filter, and for `surface` the spline through it. Computes in double and stores float: the error
/// of the tangential force is at most 3e-7 of the largest height. Thread-safe.
/// \param texture  T, grey levels, finite, at least 1 x 1
/// \throws std::invalid_argument if the texture is empty or not finite, or pitch, filter or
///   neighbourhood is out of range
[[nodiscard]] TextureField make_texture_field(const Plane<double>& texture,
                                              const RenderingOptions& options);

}  // namespace touchtrial::engine
