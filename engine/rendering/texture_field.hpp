/// \file A texture on the virtual plane, in the form that a rendering model reads.
#pragma once

#include "core/plane.hpp"
#include "core/plane_geometry.hpp"
#include "engine/rendering/rendering_options.hpp"

#include <limits>
#include <span>
#include <utility>

namespace touchtrial::engine {

/// One pixel of a field for the model `paper`, before gains.
struct FieldSample {
  float surface = 128.0F;  ///< G after the reconstruction filter, grey levels
  float force_x = 0.0F;    ///< tangential force to the right, grey levels per pixel
  float force_y = 0.0F;    ///< tangential force downwards in the image, grey levels per pixel
};

/// A field owned by another object: a mapped file of a pack, or a TextureField. It holds no name.
/// It has either samples (`paper`) or spline coefficients (`surface`), row-major,
/// geometry.height_px x geometry.width_px of them; a flat wall without texture has neither.
struct FieldView {
  PlaneGeometry geometry;
  std::span<const FieldSample> samples = {};
  /// Coefficients of the cubic B-spline through T after the reconstruction filter, grey levels
  std::span<const float> coefficients = {};
  /// Upper bound of all surface values (or coefficients), grey levels: a model need not read the
  /// field above it. Infinite if unknown.
  double highest = std::numeric_limits<double>::infinity();

  /// The model that can render the field.
  [[nodiscard]] ModelKind model() const noexcept {
    return coefficients.empty() ? ModelKind::paper : ModelKind::surface;
  }
  [[nodiscard]] bool empty() const noexcept { return samples.empty() && coefficients.empty(); }
};

/// The largest surface value or coefficient of a field; not finite if any of them is not. Reads the
/// whole field.
/// \pre the field is not empty
[[nodiscard]] double highest_of(FieldView field) noexcept;

/// A field in memory.
class TextureField {
 public:
  TextureField(PlaneGeometry geometry, Plane<FieldSample> samples);
  /// \param coefficients  as FieldView::coefficients
  TextureField(PlaneGeometry geometry, Plane<float> coefficients);

  [[nodiscard]] FieldView view() const noexcept {
    return {geometry_, samples_.samples(), coefficients_.samples(), highest_};
  }

 private:
  PlaneGeometry geometry_;
  Plane<FieldSample> samples_;
  Plane<float> coefficients_;
  double highest_;
};

/// A field with gains, for applied_sum.
struct FieldWithGains {
  FieldView field;
  Gains gains;
};

/// The sum of fields with their gains applied, less its mean height: the wall of a texture then
/// lies where the wall without it does. A model renders it with gains of 1, and a reference of 128.
/// Thread-safe.
/// \param parts  of one geometry and model
/// \throws std::invalid_argument if there is none, or they differ
[[nodiscard]] TextureField applied_sum(std::span<const FieldWithGains> parts);

/// Root mean square of a field's lateral force, or slope, in units of its samples.
[[nodiscard]] double lateral_rms(FieldView field);

/// Builds a field for the options' model from an extracted texture T. `paper`: the surface 128 + T
/// after the reconstruction filter, and its tangential force with the options' neighbourhood.
/// `surface`: the filtered T as a spline, without force planes. Computed in double, stored as
/// float. Thread-safe.
/// \param texture  T, grey levels, finite, at least 1 x 1
/// \throws std::invalid_argument if the texture is empty or not finite, or pitch, filter or
///   neighbourhood is out of range
[[nodiscard]] TextureField make_texture_field(const Plane<double>& texture,
                                              const RenderingOptions& options);

}  // namespace touchtrial::engine
