#include "engine/rendering/texture_field.hpp"

#include "engine/finite_plane.hpp"
#include "engine/force_field.hpp"
#include "engine/gaussian_filter.hpp"

#include <cmath>
#include <stdexcept>

namespace touchtrial {
namespace {

void check_options(const RenderingOptions& options) {
  if (!std::isfinite(options.pitch_mm) || options.pitch_mm <= 0.0) {
    throw std::invalid_argument("make_texture_field: the pitch must be a finite number > 0");
  }
  if (!std::isfinite(options.filter_mm) || options.filter_mm < 0.0) {
    throw std::invalid_argument("make_texture_field: the filter must be a finite number >= 0");
  }
}

}  // namespace

TextureField make_texture_field(const Plane<double>& texture, const RenderingOptions& options) {
  check_options(options);
  if (texture.empty()) throw std::invalid_argument("make_texture_field: the texture is empty");
  require_finite(texture, "make_texture_field", "texture");
  // Filter and force see only differences, so the level of 128 joins last and costs no digits.
  const Plane<double> smooth =
      gaussian_filtered(texture, to_px(options.filter_mm, options.pitch_mm));
  const ForceField<double> force = tangential_force(smooth, options.neighbourhood);
  Plane<FieldSample> samples(texture.height(), texture.width());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples.samples()[i] = {static_cast<float>(128.0 + smooth.samples()[i]),
                            static_cast<float>(force.x.samples()[i]),
                            static_cast<float>(force.y.samples()[i])};
  }
  return {{options.pitch_mm, texture.height(), texture.width()}, std::move(samples)};
}

}  // namespace touchtrial
