/// \file A texture on the virtual plane, in the form that a rendering model reads.
#pragma once

#include "core/plane.hpp"
#include "core/plane_geometry.hpp"
#include "engine/rendering/rendering_options.hpp"

#include <limits>
#include <span>
#include <utility>

namespace touchtrial::engine {

/// A field owned by another object: a mapped file of a pack, or a TextureField. It holds no name.
/// It has one plane of heights, row-major, geometry.height_px x geometry.width_px of them; a flat
/// wall without texture has none. Forces follow from the heights at the stylus.
struct FieldView {
  PlaneGeometry geometry;
  ModelKind model = ModelKind::paper;  ///< the model that can render the field
  /// `paper`: T after the reconstruction filter. `surface`: coefficients of the cubic B-spline
  /// through it. Grey levels.
  std::span<const float> heights = {};
  /// `paper`: the heights of the tangential force if they differ from `heights`: in a sum of fields
  /// whose two gains differ. As many as `heights`, or none.
  std::span<const float> other_slopes = {};
  int neighbourhood = 3;  ///< `paper`: side of the tangential force's neighbourhood, pixels
  /// Upper bound of `heights`: a model need not read the field above it. Infinite if unknown.
  double highest = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool empty() const noexcept { return heights.empty(); }
  /// The heights from which the tangential force follows.
  [[nodiscard]] std::span<const float> slopes() const noexcept {
    return other_slopes.empty() ? heights : other_slopes;
  }
};

/// The largest height of a field; not finite if any of them is not. Reads the whole field.
/// \pre the field is not empty
[[nodiscard]] double highest_of(FieldView field);

/// A field in memory.
class TextureField {
 public:
  /// \param like  geometry, model and neighbourhood of the field; its spans are not used
  /// \param heights,other_slopes  as in FieldView
  explicit TextureField(const FieldView& like, Plane<float> heights,
                        Plane<float> other_slopes = {});

  [[nodiscard]] FieldView view() const noexcept {
    FieldView view = like_;
    view.heights = heights_.samples();
    view.other_slopes = other_slopes_.samples();
    return view;
  }

 private:
  FieldView like_;  ///< without spans
  Plane<float> heights_;
  Plane<float> other_slopes_;
};

/// A field with gains, for applied_sum.
struct FieldWithGains {
  FieldView field;
  Gains gains;
};

/// The sum of fields with their gains applied, minus its mean height, so that a textured wall has
/// the same position as a flat one. A model renders it with gains of 1, and a reference of 128.
/// Thread-safe.
/// \param parts  of one geometry and model
/// \throws std::invalid_argument if there is none, or they differ
[[nodiscard]] TextureField applied_sum(std::span<const FieldWithGains> parts);

/// Root mean square of a field's lateral force, or slope, in units of its heights per pixel.
[[nodiscard]] double lateral_rms(FieldView field);

/// Builds a field for the options' model from an extracted texture T: T after the reconstruction
/// filter, and for `surface` the spline through it. Computed in double, stored as float: the
/// tangential force of the stored heights differs from that of the exact ones by no more than 3e-7
/// of the largest height. Thread-safe.
/// \param texture  T, grey levels, finite, at least 1 x 1
/// \throws std::invalid_argument if the texture is empty or not finite, or pitch, filter or
///   neighbourhood is out of range
[[nodiscard]] TextureField make_texture_field(const Plane<double>& texture,
                                              const RenderingOptions& options);

}  // namespace touchtrial::engine
