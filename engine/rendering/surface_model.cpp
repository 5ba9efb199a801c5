#include "engine/rendering/surface_model.hpp"

#include "engine/rendering/cubic_spline.hpp"
#include "engine/rendering/force_limit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace touchtrial::engine {
namespace {

/// A factor along one axis, and how it changes per mm.
struct Fade {
  double value = 1.0;
  double slope = 0.0;
};

/// 1 on the plane, 0 beyond the rim, twice continuously differentiable between.
Fade fade_at(double place_mm, double side_mm) noexcept {
  const double beyond_mm = std::max(-place_mm, place_mm - side_mm);
  if (beyond_mm <= 0.0) return {};
  if (beyond_mm >= kRimMm) return {0.0, 0.0};
  const double s = beyond_mm / kRimMm;
  const double outwards = place_mm < 0.0 ? -1.0 : 1.0;
  const double rest = 1.0 - s;
  return {1.0 - s * s * s * (10.0 + s * (6.0 * s - 15.0)),
          -outwards * 30.0 * s * s * rest * rest / kRimMm};
}

}  // namespace

SurfaceModel::SurfaceModel(FieldView field, const RenderingOptions& options, Gains gains) noexcept
    : field_(field),
      stiffness_n_per_mm_(options.stiffness_n_per_mm),
      damping_n_s_per_mm_(options.damping_n_s_per_mm),
      friction_(options.friction),
      bristle_n_per_mm_(options.texture_stiffness_n_per_mm / std::numbers::sqrt2),
      max_force_n_(options.max_force_n),
      mm_per_grey_(field.coefficients.empty() ? 0.0 : gains.height_mm),
      // B-splines are weighted means: none is higher than its highest coefficient.
      reach_mm_(mm_per_grey_ > 0.0 ? std::max(0.0, mm_per_grey_ * field.highest) : 0.0) {}

Vec3 SurfaceModel::force_n(Vec3 position_mm, Vec3 velocity_mm_s, Bristle& bristle) const noexcept {
  const bool in_reach = position_mm.z < reach_mm_;
  if (in_reach && is_finite(position_mm) && is_finite(velocity_mm_s)) {
    return contact_force_n(position_mm, velocity_mm_s, bristle);
  }
  bristle.release();
  return {};
}

Vec3 SurfaceModel::contact_force_n(Vec3 position_mm, Vec3 velocity_mm_s,
                                   Bristle& bristle) const noexcept {
  const Relief relief = relief_at(position_mm.x, position_mm.y);
  const double elastic_n = stiffness_n_per_mm_ * (relief.height_mm - position_mm.z);
  if (!(elastic_n > 0.0)) {
    bristle.release();
    return {};
  }
  const double normal_n = std::max(0.0, elastic_n - damping_n_s_per_mm_ * velocity_mm_s.z);
  Vec3 force_n{-elastic_n * relief.slope.x, -elastic_n * relief.slope.y, normal_n};
  if (friction_ > 0.0) {
    const Vec2 friction_n =
        bristle.friction_n({position_mm.x, position_mm.y}, friction_ * normal_n, bristle_n_per_mm_);
    force_n.x += friction_n.x;
    force_n.y += friction_n.y;
  }
  return limited_in_norm(force_n, max_force_n_);
}

SurfaceModel::Relief SurfaceModel::relief_at(double x_mm, double y_mm) const noexcept {
  if (mm_per_grey_ == 0.0) return {};
  const PlaneGeometry& plane = field_.geometry;
  const bool on_plane = plane.contains(x_mm, y_mm);
  const Fade across = on_plane ? Fade{} : fade_at(x_mm, plane.width_mm());
  const Fade down = on_plane ? Fade{} : fade_at(y_mm, plane.height_mm());
  if (across.value == 0.0 || down.value == 0.0) return {};
  const Vec2 px = plane.to_px(x_mm, y_mm);
  const SplinePoint h = spline_at(field_.coefficients, plane.height_px, plane.width_px, px.x, px.y);
  const double per_mm = mm_per_grey_ / plane.pitch_mm;
  const double height_mm = mm_per_grey_ * h.value;
  return {height_mm * across.value * down.value,
          {(per_mm * h.along_x * across.value + height_mm * across.slope) * down.value,
           (per_mm * h.along_y * down.value + height_mm * down.slope) * across.value}};
}

}  // namespace touchtrial::engine
