/// \file Textures, fields and a percentile that several tests of rendering and packs use.
#pragma once

#include "core/random.hpp"
#include "engine/rendering/model_parts.hpp"
#include "engine/rendering/texture_field.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace touchtrial {

/// Independent grey levels in [-amplitude, amplitude).
inline Plane<double> random_texture(int height, int width, std::uint64_t seed,
                                    double amplitude = 40.0) {
  RandomStream random(seed, "test texture");
  Plane<double> texture(height, width);
  for (double& value : texture.samples()) value = random.uniform(-amplitude, amplitude);
  return texture;
}

inline engine::TextureField random_field(int height, int width, std::uint64_t seed,
                                         double amplitude = 40.0) {
  return engine::make_texture_field(random_texture(height, width, seed, amplitude), {});
}

inline engine::TextureField flat_field(int height, int width) {
  return engine::make_texture_field(Plane<double>(height, width, 0.0), {});
}

inline engine::RenderingOptions surface_options() {
  return {.model = engine::ModelKind::surface};
}

inline engine::TextureField random_surface(int height, int width, std::uint64_t seed,
                                           double amplitude = 40.0) {
  return engine::make_texture_field(random_texture(height, width, seed, amplitude),
                                    surface_options());
}

inline engine::TextureField flat_surface(int height, int width) {
  return engine::make_texture_field(Plane<double>(height, width, 0.0), surface_options());
}

/// A field of model `paper` with these heights.
inline engine::FieldView view_of_heights(const std::vector<float>& heights, int height, int width) {
  return {.geometry = {0.2, height, width}, .heights = heights};
}

inline engine::SampledField sampled(engine::FieldView field) {
  return engine::parts_of(field.model).sampled(field);
}

inline std::vector<engine::FieldView> views_of(const std::vector<engine::TextureField>& fields) {
  std::vector<engine::FieldView> views;
  for (const engine::TextureField& field : fields) views.push_back(field.view());
  return views;
}

/// NumPy's percentile, from a sorted list.
inline double percentile_slowly(std::vector<double> values, double share) {
  std::ranges::sort(values);
  const double position = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (position - std::floor(position)) * (values[above] - values[below]);
}

}  // namespace touchtrial
