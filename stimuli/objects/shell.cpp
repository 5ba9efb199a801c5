#include "stimuli/noise.hpp"
#include "stimuli/recipes.hpp"
#include "stimuli/relief.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::stimuli {
namespace {

constexpr double kHalfAngle = 1.02;  ///< of the fan, radians

/// The shape and position of a shell, units.
struct ShellShape {
  Vec2 hinge{250.0, 446.0};
  double radius = 392.0;
  double rib_angle = 0.094;  ///< between two ribs, radians
  double dome = 84.0;        ///< height of the bulge
  double years = 17.0;       ///< number of growth terraces
};

/// The outside of a scallop shell: ribs fan out from the hinge and are crossed by growth bands.
class Shell {
 public:
  explicit Shell(std::uint64_t seed, const ShellShape& shape = {})
      : shape_(shape),
        sway_(seed, "shell/sway"),
        growth_(seed, "shell/growth"),
        grain_(seed, "shell/grain") {}

  [[nodiscard]] ObjectPoint operator()(double x, double y) const {
    const double dx = x - shape_.hinge.x + 2.0 * sway_.at(x / 80, y / 80);
    const double dy = shape_.hinge.y - y;
    const double angle = std::atan2(dx, dy + 1e-9);
    const double r = std::sqrt(dx * dx + dy * dy);
    if (const ObjectPoint fan = fan_point(x, y, angle, r); fan.is_object) return fan;
    return ear_point(x, y, dx, dy);
  }

 private:
  /// Height of the rib profile, 0 in a groove, 1 on a crest.
  [[nodiscard]] double rib(double angle, double r) const {
    const double position = (angle + 0.008 * sway_.at(angle * 9, r / 90)) / shape_.rib_angle;
    const double t = 2.0 * (position - std::floor(position)) - 1.0;
    return std::sqrt(std::max(0.0, 1.0 - t * t * t * t)) * (1.0 - 0.25 * t * t);
  }

  [[nodiscard]] double margin(double angle) const {
    const double t = angle / kHalfAngle;
    return shape_.radius * (1.0 - 0.25 * t * t - 0.10 * t * t * t * t);
  }

  [[nodiscard]] ObjectPoint fan_point(double x, double y, double angle, double r) const {
    const double edge =
        margin(angle) + 7.0 * rib(angle, shape_.radius) + 2.0 * sway_.at(x / 20, y / 20);
    const double side = kHalfAngle * (0.86 + 0.14 * smooth_step(0.0, 0.5, r / shape_.radius));
    if (std::abs(angle) >= side || r >= edge) return {};
    const double share = r / edge;  // 0 at the hinge, 1 at the margin
    const double ripple = growth_rings(share, angle);
    const double crest = rib(angle, r);
    const double to_side = 1.0 - std::abs(angle) / side;
    const double dome = shape_.dome * std::sqrt(std::max(0.0, share * (1.02 - share) * 3.6)) *
                        std::sqrt(smooth_step(0.0, 0.75, to_side) + 0.02);
    const double grain = grain_.fractal(x / 3.4, y / 3.4, 3);
    SurfacePoint point;
    point.height_px = 6.0 + dome + (2.0 + 8.0 * share) * crest + 2.6 * ripple + 0.7 * grain;
    point.albedo =
        std::clamp(0.50 + 0.20 * bands(share, angle) + 0.08 * crest + 0.10 * grain, 0.1, 1.0);
    return {true, point};
  }

  /// Growth terraces at irregular distances, with a slow rise and a steep fall.
  [[nodiscard]] double growth_rings(double share, double angle) const {
    const double position = shape_.years * share * (0.7 + 0.5 * share) +
                            1.2 * growth_.fractal(share * 6, 0.7, 3) +
                            0.12 * sway_.at(angle * 14, share * 30);
    const double coarse = position - std::floor(position);
    const double fine = 3.7 * position - std::floor(3.7 * position);
    return coarse * smooth_step(1.0, 0.86, coarse) + 0.5 * fine * smooth_step(1.0, 0.8, fine);
  }

  /// Interrupted bands of colour across the ribs.
  [[nodiscard]] double bands(double share, double angle) const {
    return growth_.fractal(share * 9 + 30, 0.4 + 0.5 * sway_.at(angle * 5, share * 5), 3) +
           0.7 * growth_.fractal(share * 26, angle * 7, 2);
  }

  /// The flat wings next to the hinge.
  [[nodiscard]] ObjectPoint ear_point(double x, double y, double dx, double dy) const {
    const double side_distance = std::abs(dx);
    const double top = 78.0 - 0.16 * side_distance;
    if (dy < -6.0 || dy > top || side_distance > 96.0 - 0.25 * dy + 3.0 * sway_.at(y / 18, 2.2))
      return {};
    const double line = (side_distance + 0.3 * dy) / 7.5;
    const double ridge = std::abs(2.0 * (line - std::floor(line)) - 1.0);
    const double grain = grain_.fractal(x / 3.4, y / 3.4, 3);
    return {true,
            {9.0 + 1.6 * ridge + 0.05 * dy + 0.7 * grain + 0.8 * growth_.at(dy / 7, 8.8),
             std::clamp(0.46 + 0.1 * grain + 0.12 * growth_.fractal(dy / 16, 5.5, 2), 0.1, 1.0)}};
  }

  ShellShape shape_;
  Noise sway_;
  Noise growth_;
  Noise grain_;
};

}  // namespace

GreyImage make_shell(const Specimen& specimen, int size_px) {
  const Lamp lamp{{-0.62, -0.42, 0.8}, 0.36, 60.0, 5.0, 9.0, 0.78};
  return draw_object(specimen, size_px, Shell(specimen.noise_seed()), lamp, {112.0});
}

GreyImage make_ribs(const Specimen& specimen, int size_px) {
  // The shell is so large that its hinge and its margin are outside the picture.
  ShellShape shape;
  shape.hinge = {170.0 + specimen.shift("ribs/hinge", 160.0), 1120.0};
  shape.radius = 1750.0;
  shape.rib_angle = 0.040 * specimen.factor("ribs/angle", 0.2);
  shape.dome = 0.0;
  shape.years = 62.0 * specimen.factor("ribs/years", 0.25);
  const Shell shell(specimen.noise_seed(), shape);
  const Noise warp(specimen.noise_seed(), "ribs/warp");
  const auto ribs = [&](double x, double y) {
    const double u = x + 4.0 * warp.fractal(x / 130, y / 190, 2);
    const double v = y + 14.0 * warp.fractal(x / 90 + 30, y / 140, 2);
    SurfacePoint point = shell(u, v).surface;
    point.height_px += 6.0 * warp.fractal(x / 80 + 60, y / 80, 3);
    return point;
  };
  const Lamp lamp{{-0.62, -0.42, 0.8}, 0.36, 40.0, 5.0, 9.0};
  return draw_surface(specimen, size_px, ribs, view_of(specimen, {0.12, 0.15, 0.2}), lamp, {118.0});
}

}  // namespace touchtrial::stimuli
