#include "engine/reference/loop_work.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace touchtrial::reference {
namespace {

double side_work_mj(const engine::RenderingModel& model, engine::Bristle& touch, Vec3 from_mm,
                    Vec3 to_mm, double step_mm) {
  const Vec3 way_mm = to_mm - from_mm;
  const double steps = std::max(1.0, std::ceil(norm(way_mm) / step_mm));
  const auto along_n = [&](double share) {
    return dot(model.force_n(from_mm + share * way_mm, {}, touch), way_mm);
  };
  double sum = along_n(0.0);
  for (double i = 0.0; i < steps; ++i) {
    sum += 4.0 * along_n((i + 0.5) / steps);
    sum += (i + 1.0 < steps ? 2.0 : 1.0) * along_n((i + 1.0) / steps);
  }
  return sum / (6.0 * steps);
}

}  // namespace

std::vector<Vec3> circle_path(Vec3 centre_mm, double radius_mm, int corners) {
  std::vector<Vec3> path;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    path.push_back(centre_mm + radius_mm * Vec3{std::cos(angle), std::sin(angle), 0.0});
  }
  return path;
}

std::vector<Vec3> press_slide_lift_path(Vec2 from_mm, Vec2 to_mm, double top_mm, double bottom_mm) {
  return {{from_mm.x, from_mm.y, top_mm},
          {from_mm.x, from_mm.y, bottom_mm},
          {to_mm.x, to_mm.y, bottom_mm},
          {to_mm.x, to_mm.y, top_mm}};
}

double loop_work_mj(const engine::RenderingModel& model, std::span<const Vec3> corners_mm,
                    double step_mm) {
  engine::Bristle touch;
  double work_mj = 0.0;
  for (std::size_t i = 0; i < corners_mm.size(); ++i) {
    const Vec3 next_mm = corners_mm[(i + 1) % corners_mm.size()];
    work_mj += side_work_mj(model, touch, corners_mm[i], next_mm, step_mm);
  }
  return work_mj;
}

}  // namespace touchtrial::reference
