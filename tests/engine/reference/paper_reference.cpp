#include "engine/reference/paper_reference.hpp"

#include "engine/reference/force_reference.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace touchtrial::reference {
namespace {

Plane<double> plane_of(std::span<const float> samples, const PlaneGeometry& geometry) {
  Plane<double> plane(geometry.height_px, geometry.width_px);
  std::ranges::copy(samples, plane.samples().begin());
  return plane;
}

/// The share of the lateral force at a load on the touchdown ramp, or beyond it.
double share_of(double load_n, double ramp_n) {
  return ramp_n == 0.0 ? 1.0 : std::min(1.0, load_n / ramp_n);
}

}  // namespace

PaperForce::PaperForce(engine::FieldView field, const engine::RenderingOptions& options,
                       engine::Gains gains)
    : geometry_(field.geometry),
      options_(options),
      gains_(gains),
      heights_(plane_of(field.heights, geometry_)),
      force_(tangential_force(plane_of(field.slopes(), geometry_), field.neighbourhood)) {}

double PaperForce::at(const Plane<double>& values, double x_mm, double y_mm) const {
  const Vec2 px = geometry_.to_px(x_mm, y_mm);
  double sum = 0.0;
  for (int y = -1; y <= values.height(); ++y) {
    for (int x = -1; x <= values.width(); ++x) {
      const double weight =
          std::max(0.0, 1.0 - std::abs(px.x - x)) * std::max(0.0, 1.0 - std::abs(px.y - y));
      const int row = std::clamp(y, 0, values.height() - 1);
      const int column = std::clamp(x, 0, values.width() - 1);
      sum += weight * values.at(row, column);
    }
  }
  return sum;
}

Vec3 PaperForce::force_n(const Vec3& position_mm, const Vec3& velocity_mm_s) const {
  const auto [x, y, z] = position_mm;
  double elastic_n = options_.stiffness_n_per_mm * -z;
  Vec2 lateral;
  if (geometry_.contains(x, y)) {
    elastic_n += gains_.normal_n * (128.0 + at(heights_, x, y) - options_.reference_grey);
    lateral = {at(force_.x, x, y), at(force_.y, x, y)};
    if (options_.reference_grey == 0.0 && z >= 0.0) return {};
  }
  const double normal_n = elastic_n - options_.damping_n_s_per_mm * velocity_mm_s.z;
  const double load_n = std::min(elastic_n, normal_n);
  if (load_n <= 0.0) return {};
  const double tangential_n = gains_.tangential_n * share_of(load_n, options_.touchdown_ramp_n);
  const Vec3 force_n{tangential_n * lateral.x, tangential_n * lateral.y, normal_n};
  return std::min(1.0, options_.max_force_n / norm(force_n)) * force_n;
}

}  // namespace touchtrial::reference
