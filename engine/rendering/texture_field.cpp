#include "engine/rendering/texture_field.hpp"

#include "engine/finite_plane.hpp"
#include "engine/gaussian_filter.hpp"
#include "engine/kernels/texture_rows.hpp"
#include "engine/rendering/field_statistics.hpp"
#include "engine/rendering/model_parts.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace touchtrial::engine {
namespace {

void check_options(const RenderingOptions& options) {
  if (!std::isfinite(options.pitch_mm) || options.pitch_mm <= 0.0) {
    throw std::invalid_argument("make_texture_field: the pitch must be a finite number > 0");
  }
  if (!std::isfinite(options.filter_mm) || options.filter_mm < 0.0) {
    throw std::invalid_argument("make_texture_field: the filter must be a finite number >= 0");
  }
}

/// \throws std::invalid_argument if the fields cannot be added
void check_parts(std::span<const FieldWithGains> parts) {
  if (parts.empty()) throw std::invalid_argument("sum_with_gains: there is no field");
  const FieldView& first = parts.front().field;
  for (const FieldWithGains& part : parts) {
    if (part.field.empty() || part.field.geometry != first.geometry ||
        part.field.model != first.model || part.field.neighbourhood != first.neighbourhood) {
      throw std::invalid_argument("sum_with_gains: a field is empty or differs from the first");
    }
  }
}

/// Subtracts the mean, in double.
void centre(Plane<double>& heights) {
  double sum = 0.0;
  for (const double height : heights.samples()) sum += height;
  const double mean = sum / static_cast<double>(heights.size());
  for (double& height : heights.samples()) height -= mean;
}

}  // namespace

double highest_of(FieldView field) {
  return highest_sample(field.heights);
}

TextureField::TextureField(const FieldView& properties, Plane<float> heights,
                           Plane<float> slope_heights)
    : properties_{.geometry = properties.geometry,
                  .model = properties.model,
                  .neighbourhood = properties.neighbourhood},
      heights_(std::move(heights)),
      slope_heights_(std::move(slope_heights)) {
  if (!heights_.empty()) properties_.highest = highest_of(view());
}

TextureField make_texture_field(const Plane<double>& texture, const RenderingOptions& options) {
  check_options(options);
  if (texture.empty()) throw std::invalid_argument("make_texture_field: the texture is empty");
  require_finite(texture, "make_texture_field", "texture");
  return parts_of(options.model)
      .make_field(gaussian_filtered(texture, to_px(options.filter_mm, options.pitch_mm)), options);
}

TextureField sum_with_gains(std::span<const FieldWithGains> parts) {
  check_parts(parts);
  const FieldView& first = parts.front().field;
  const PlaneGeometry plane = first.geometry;
  const bool is_surface = first.model == ModelKind::surface;
  Plane<double> heights(plane.height_px, plane.width_px);
  Plane<double> slopes(is_surface ? 0 : plane.height_px, is_surface ? 0 : plane.width_px);
  const auto add = [](Plane<double>& sum, double gain, std::span<const float> part) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum.samples()[i] += gain * double{part[i]};
  };
  for (const auto& [field, gains] : parts) {
    add(heights, is_surface ? gains.height_mm : gains.normal_n, field.heights);
    add(slopes, gains.tangential_n, is_surface ? std::span<const float>() : field.slopes());
  }
  centre(heights);
  return TextureField(first, converted<float>(heights), converted<float>(slopes));
}

double lateral_rms(FieldView field) {
  const ForceField<double> force = lateral_field(field, {}).force;
  double sum = 0.0;
  for (std::size_t i = 0; i < force.x.size(); ++i) {
    const double x = force.x.samples()[i];
    const double y = force.y.samples()[i];
    sum += x * x + y * y;
  }
  return std::sqrt(sum / static_cast<double>(force.x.size()));
}

}  // namespace touchtrial::engine
