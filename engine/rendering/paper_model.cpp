#include "engine/rendering/paper_model.hpp"

#include "engine/rendering/force_limit.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::engine {
namespace {

/// Texture values at a point between pixels.
struct Texture {
  double surface;
  double force_x;
  double force_y;
};

Texture texture_at(const FieldView& field, double x_mm, double y_mm) noexcept {
  const PlaneGeometry& plane = field.geometry;
  const Vec2 px = plane.to_px(x_mm, y_mm);
  const double x = std::clamp(px.x, 0.0, plane.width_px - 1.0);
  const double y = std::clamp(px.y, 0.0, plane.height_px - 1.0);
  const auto left = static_cast<int>(x);
  const auto top = static_cast<int>(y);
  const std::size_t right_step = left + 1 < plane.width_px ? 1 : 0;
  const std::size_t down_step = top + 1 < plane.height_px ? plane.width_px : 0;
  const FieldSample* corner =
      field.samples.data() + static_cast<std::size_t>(top) * plane.width_px + left;
  const double to_right = x - left;
  const double to_down = y - top;
  const auto mixed = [&](float FieldSample::*value) {
    const double a = corner->*value;
    const double b = corner[right_step].*value;
    const double c = corner[down_step].*value;
    const double d = corner[down_step + right_step].*value;
    const double upper = a + to_right * (b - a);
    const double lower = c + to_right * (d - c);
    return upper + to_down * (lower - upper);
  };
  return {mixed(&FieldSample::surface), mixed(&FieldSample::force_x), mixed(&FieldSample::force_y)};
}

}  // namespace

PaperModel::PaperModel(FieldView field, const RenderingOptions& options, Gains gains) noexcept
    : field_(field),
      stiffness_n_per_mm_(options.stiffness_n_per_mm),
      damping_n_s_per_mm_(options.damping_n_s_per_mm),
      reference_grey_(options.reference_grey),
      max_force_n_(options.max_force_n),
      gains_(gains) {}

Vec3 PaperModel::force_n(Vec3 position_mm, Vec3 velocity_mm_s) const noexcept {
  if (!is_finite(position_mm) || !is_finite(velocity_mm_s)) return {};
  double elastic_n = -stiffness_n_per_mm_ * position_mm.z;
  Texture texture{reference_grey_, 0.0, 0.0};
  if (field_.geometry.contains(position_mm.x, position_mm.y) && !field_.samples.empty()) {
    if (is_out_of_reach(elastic_n)) return {};
    texture = texture_at(field_, position_mm.x, position_mm.y);
    elastic_n += gains_.normal_n * (texture.surface - reference_grey_);
  }
  const double normal_n = elastic_n - damping_n_s_per_mm_ * velocity_mm_s.z;
  if (!(elastic_n > 0.0 && normal_n > 0.0)) return {};
  return limited_in_norm(
      {gains_.tangential_n * texture.force_x, gains_.tangential_n * texture.force_y, normal_n},
      max_force_n_);
}

bool PaperModel::is_out_of_reach(double wall_n) const noexcept {
  if (reference_grey_ == 0.0 && wall_n <= 0.0) return true;
  return wall_n + gains_.normal_n * (field_.highest - reference_grey_) <= 0.0;
}

}  // namespace touchtrial::engine
