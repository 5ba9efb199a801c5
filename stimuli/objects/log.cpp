#include "stimuli/noise.hpp"
#include "stimuli/recipes.hpp"
#include "stimuli/relief.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::stimuli {
namespace {

constexpr double kBark = 24.0;  ///< thickness of the bark

/// The shape and position of a log's end, units.
struct LogShape {
  Vec2 middle{250.0, 252.0};
  Vec2 pith{232.0, 268.0};  ///< rings are wider on one side
  double radius = 206.0;    ///< of the wood
  double years = 34.0;
  double ring_shift = 2.6;  ///< shift of the rings by years of different growth, years
  double saw = 0.55;        ///< height of the saw marks, units
  double rays = 60.0;       ///< wood rays per radian
  int cracks = 9;
};

/// The sawn end of a log: growth rings, drying cracks, saw marks, and bark around it.
class LogEnd {
 public:
  explicit LogEnd(std::uint64_t seed, const LogShape& shape = {})
      : shape_(shape),
        sway_(seed, "log/sway"),
        rings_(seed, "log/rings"),
        grain_(seed, "log/grain"),
        bark_(seed, "log/bark"),
        cracks_(seed, "log/cracks") {}

  [[nodiscard]] ObjectPoint operator()(double x, double y) const {
    const Vec2 d{x - shape_.middle.x, y - shape_.middle.y};
    const double r = std::sqrt(d.x * d.x + d.y * d.y) + 1e-9;
    const Vec2 direction = (1.0 / r) * d;
    const double wood =
        shape_.radius * (1.0 + 0.06 * sway_.fractal(1.4 * direction.x, 1.4 * direction.y, 2));
    const double roughness = bark_.fractal(6.0 * direction.x + 3, 6.0 * direction.y, 3);
    if (r >= wood + kBark * (1.0 + 0.45 * roughness)) return {};
    if (r >= wood) return {true, bark_point(x, y, r - wood, direction)};
    return {true, wood_point(x, y, r / wood, direction)};
  }

 private:
  /// The position from the pith (0) to the bark (1). Only the outer rings follow the outline.
  [[nodiscard]] double ring_position(double x, double y, double share) const {
    const Vec2 p{x - shape_.pith.x, y - shape_.pith.y};
    const double pith_share = std::sqrt(p.x * p.x + p.y * p.y) / shape_.radius;
    const double position = mix(pith_share, share, smooth_step(0.0, 1.0, share));
    return position + 3.708 / shape_.radius * sway_.fractal(x / 60, y / 60, 3);
  }

  [[nodiscard]] SurfacePoint wood_point(double x, double y, double share, Vec2 direction) const {
    const double position = ring_position(x, y, share);
    // Rings differ in width between years.
    const double year =
        shape_.years * position + shape_.ring_shift * rings_.fractal(7.0 * position, 0.5, 3);
    const double season = year - std::floor(year);
    const double late_wood = smooth_step(0.25, 0.85, season) * smooth_step(1.0, 0.93, season);
    const double ray = grain_.fractal(shape_.rays * direction.x, shape_.rays * direction.y, 2);
    const double pore = grain_.fractal(x / 2.4, y / 2.4, 2);
    const double saw = grain_.at((x + 0.45 * y) / 3.6, (0.45 * x - y) / 130);
    const double crack = crack_depth(x, y);
    SurfacePoint point;
    point.height_px =
        46.0 + 2.0 * late_wood + shape_.saw * saw + 0.5 * pore + 0.35 * ray - 12.0 * crack;
    point.albedo = 0.66 - 0.24 * late_wood + 0.06 * ray + 0.08 * pore -
                   0.14 * smooth_step(0.62, 0.2, position) * 0.8 +
                   0.09 * sway_.fractal(x / 50 + 7, y / 50, 3);
    point.albedo = std::clamp(point.albedo * (1.0 - 0.85 * crack), 0.04, 1.0);
    return point;
  }

  /// Cracks run outwards from the pith and widen; each has its own direction and end.
  [[nodiscard]] double crack_depth(double x, double y) const {
    const Vec2 p{x - shape_.pith.x, y - shape_.pith.y};
    const double r = std::sqrt(p.x * p.x + p.y * p.y);
    double depth = 0.0;
    for (std::int64_t i = 0; i < shape_.cracks; ++i) {
      const Vec2 direction = cracks_.direction(cracks_.hash(i, 3));
      const double along = p.x * direction.x + p.y * direction.y;
      if (along <= 0.0) continue;
      const double across = p.y * direction.x - p.x * direction.y +
                            5.0 * sway_.fractal(r / 40 + 9.0 * static_cast<double>(i), 1.1, 3);
      const double crack_start =
          shape_.radius * (i == 0 ? 0.0 : 0.55 * cracks_.value(cracks_.hash(i, 1)));
      const double crack_end = shape_.radius * (0.6 + 0.42 * cracks_.value(cracks_.hash(i, 2)));
      const double opening = (i == 0 ? 3.6 : 1.9) *
                             smooth_step(crack_start - 8.0, crack_start + 50.0, along) *
                             smooth_step(crack_end, crack_end - 50.0, along);
      depth = std::max(depth, smooth_step(opening + 0.3, opening * 0.4, std::abs(across)) *
                                  std::min(1.0, opening));
    }
    return depth;
  }

  [[nodiscard]] SurfacePoint bark_point(double x, double y, double bark_depth,
                                        Vec2 direction) const {
    const double ridge = bark_.ridged(16.0 * direction.x, 16.0 * direction.y, 3);
    const double lump = bark_.fractal(x / 8, y / 8, 4);
    const double t = bark_depth / kBark;
    const double gap = smooth_step(2.5, 0.0, bark_depth);
    const double fall = 40.0 * std::sqrt(std::max(0.0, 1.0 - 0.75 * t * t));
    SurfacePoint point;
    point.height_px = fall + 4.0 * ridge + 3.2 * lump - 5.0 * gap - 2.0;
    point.albedo = std::clamp(0.30 + 0.16 * lump + 0.08 * ridge - 0.14 * gap, 0.05, 1.0);
    return point;
  }

  LogShape shape_;
  Noise sway_;
  Noise rings_;
  Noise grain_;
  Noise bark_;
  Lattice cracks_;
};

}  // namespace

GreyImage make_log(const Specimen& specimen, int size_px) {
  const Lamp lamp{{-0.62, -0.5, 0.62}, 0.32, 55.0, 4.0, 7.0, 0.78};
  return draw_object(specimen, size_px, LogEnd(specimen.noise_seed()), lamp, {116.0});
}

GreyImage make_endgrain(const Specimen& specimen, int size_px) {
  // The pith is outside the picture at the lower left, the bark at the upper right.
  LogShape shape;
  shape.pith = {-150.0 + specimen.shift("endgrain/x", 60.0),
                640.0 + specimen.shift("endgrain/y", 60.0)};
  shape.middle = shape.pith;
  shape.radius = 1000.0;
  shape.years = 60.0 * specimen.factor("endgrain/years", 0.3);
  shape.ring_shift = 6.5;
  shape.saw = 0.25;
  shape.rays = 330.0;
  shape.cracks = 13;
  const LogEnd log(specimen.noise_seed(), shape);
  const auto wood = [&](double x, double y) { return log(x, y).surface; };
  const Lamp lamp{{-0.62, -0.5, 0.62}, 0.32, 30.0, 4.0, 7.0};
  return draw_surface(specimen, size_px, wood, view_of(specimen, {0.12, 0.2, 0.2}), lamp, {118.0});
}

}  // namespace touchtrial::stimuli
