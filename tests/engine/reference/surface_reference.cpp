#include "engine/reference/surface_reference.hpp"

#include "engine/rendering/cubic_spline.hpp"
#include "engine/rendering/surface_model.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::reference {
namespace {

/// 1 on the plane, 0 beyond the rim, the smoothest polynomial of degree five between.
double fade(double place_mm, double side_mm) {
  const double beyond_mm = std::max({0.0, -place_mm, place_mm - side_mm});
  const double s = std::min(1.0, beyond_mm / engine::kRimMm);
  return 1.0 - 10.0 * std::pow(s, 3) + 15.0 * std::pow(s, 4) - 6.0 * std::pow(s, 5);
}

}  // namespace

double surface_potential_mj(engine::FieldView field, double stiffness_n_per_mm, double alpha_mm,
                            Vec3 position_mm) {
  const PlaneGeometry& plane = field.geometry;
  const Vec2 px = plane.to_px(position_mm.x, position_mm.y);
  const double h =
      engine::spline_at(field.coefficients, plane.height_px, plane.width_px, px.x, px.y).value *
      fade(position_mm.x, plane.width_mm()) * fade(position_mm.y, plane.height_mm());
  const double pressed_mm = std::max(0.0, alpha_mm * h - position_mm.z);
  return 0.5 * stiffness_n_per_mm * pressed_mm * pressed_mm;
}

}  // namespace touchtrial::reference
