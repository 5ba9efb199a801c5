#include "engine/rendering/texture_field.hpp"

#include "engine/finite_plane.hpp"
#include "engine/gaussian_filter.hpp"
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

}  // namespace touchtrial::engine
