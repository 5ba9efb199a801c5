#include "engine/rendering/texture_field.hpp"

#include "engine/finite_plane.hpp"
#include "engine/gaussian_filter.hpp"
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

/// The largest value, or the first that is not finite.
template <typename Range, typename HeightOf>
double highest_in(const Range& range, HeightOf height_of) noexcept {
  float highest = height_of(range.front());
  for (const auto& entry : range) {
    const float height = height_of(entry);
    if (!std::isfinite(height)) return height;
    highest = std::max(highest, height);
  }
  return highest;
}

/// \throws std::invalid_argument if the fields cannot be added
void check_parts(std::span<const FieldWithGains> parts) {
  if (parts.empty()) throw std::invalid_argument("applied_sum: there is no field");
  const FieldView& first = parts.front().field;
  for (const FieldWithGains& part : parts) {
    if (part.field.empty() || part.field.geometry != first.geometry ||
        part.field.model() != first.model()) {
      throw std::invalid_argument("applied_sum: a field is empty or differs from the first");
    }
  }
}

/// Takes the mean off, in double.
void centre(Plane<double>& heights) {
  double sum = 0.0;
  for (const double height : heights.samples()) sum += height;
  const double mean = sum / static_cast<double>(heights.size());
  for (double& height : heights.samples()) height -= mean;
}

}  // namespace

double highest_of(FieldView field) noexcept {
  if (!field.coefficients.empty()) {
    return highest_in(field.coefficients, [](float coefficient) { return coefficient; });
  }
  return highest_in(field.samples, [](const FieldSample& sample) { return sample.surface; });
}

TextureField::TextureField(PlaneGeometry geometry, Plane<FieldSample> samples)
    : geometry_(geometry),
      samples_(std::move(samples)),
      highest_(highest_of({geometry, samples_.samples()})) {}

TextureField::TextureField(PlaneGeometry geometry, Plane<float> coefficients)
    : geometry_(geometry),
      coefficients_(std::move(coefficients)),
      highest_(highest_of({geometry, {}, coefficients_.samples()})) {}

TextureField make_texture_field(const Plane<double>& texture, const RenderingOptions& options) {
  check_options(options);
  if (texture.empty()) throw std::invalid_argument("make_texture_field: the texture is empty");
  require_finite(texture, "make_texture_field", "texture");
  return parts_of(options.model)
      .make_field(gaussian_filtered(texture, to_px(options.filter_mm, options.pitch_mm)), options);
}

TextureField applied_sum(std::span<const FieldWithGains> parts) {
  check_parts(parts);
  const PlaneGeometry plane = parts.front().field.geometry;
  const bool is_surface = parts.front().field.model() == ModelKind::surface;
  Plane<double> heights(plane.height_px, plane.width_px);
  Plane<FieldSample> samples(is_surface ? 0 : plane.height_px, is_surface ? 0 : plane.width_px,
                             {0.0F, 0.0F, 0.0F});
  for (const auto& [field, gains] : parts) {
    for (std::size_t i = 0; i < heights.size(); ++i) {
      if (is_surface) {
        heights.samples()[i] += gains.height_mm * static_cast<double>(field.coefficients[i]);
        continue;
      }
      const FieldSample& sample = field.samples[i];
      FieldSample& sum = samples.samples()[i];
      heights.samples()[i] += gains.normal_n * (static_cast<double>(sample.surface) - 128.0);
      sum.force_x += static_cast<float>(gains.tangential_n * static_cast<double>(sample.force_x));
      sum.force_y += static_cast<float>(gains.tangential_n * static_cast<double>(sample.force_y));
    }
  }
  centre(heights);
  if (is_surface) {
    Plane<float> coefficients(plane.height_px, plane.width_px);
    std::ranges::transform(heights.samples(), coefficients.samples().begin(),
                           [](double height) { return static_cast<float>(height); });
    return {plane, std::move(coefficients)};
  }
  for (std::size_t i = 0; i < heights.size(); ++i) {
    samples.samples()[i].surface = static_cast<float>(128.0 + heights.samples()[i]);
  }
  return {plane, std::move(samples)};
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
