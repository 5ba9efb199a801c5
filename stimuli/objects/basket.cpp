#include "stimuli/noise.hpp"
#include "stimuli/recipes.hpp"
#include "stimuli/relief.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::stimuli {
namespace {

constexpr double kMiddle = 250.0;
constexpr double kRim = 138.0;    ///< upper edge of the body
constexpr double kFoot = 462.0;   ///< lower edge
constexpr double kBulge = 85.0;   ///< depth of the round body
constexpr double kRow = 15.0;     ///< height of a row of rods
constexpr double kStake = 0.125;  ///< angle between two stakes, radians

/// A round basket of rods woven around upright stakes, with a twisted rim and handle.
class Basket {
 public:
  explicit Basket(std::uint64_t seed)
      : sway_(seed, "basket/sway"),
        rods_(seed, "basket/rods"),
        fibres_(seed, "basket/fibres"),
        traits_(seed, "basket/traits") {}

  [[nodiscard]] ObjectPoint operator()(double x, double y) const {
    const double wx = x + 2.0 * sway_.at(x / 90, y / 90);
    const double wy = y + 2.0 * sway_.at(x / 90 + 30, y / 90);
    if (const ObjectPoint rim = rim_point(wx, wy); rim.is_object) return rim;
    if (const ObjectPoint body = body_point(wx, wy); body.is_object) return body;
    return handle_point(wx, wy);
  }

  /// A point of the weave: rods over and under the stakes, row by row.
  /// \param angle  around the basket, radians
  /// \param v  downwards, units
  [[nodiscard]] SurfacePoint weave_point(double angle, double v) const {
    const double wobble = 2.0 * sway_.fractal(angle * 4 + 9, v / 60, 2);
    const double row = std::floor((v + wobble) / kRow);
    const auto row_number = static_cast<std::int64_t>(row);
    const double across = 2.0 * ((v + wobble) / kRow - row) - 1.0;
    const double position = angle / kStake + 0.12 * sway_.at(angle * 9, row * 0.31);
    const double parity = static_cast<double>(row_number & 1);
    const double wave = std::cos(3.14159265358979 * (position + parity));
    const double thickness = 0.86 + 0.16 * traits_.value(traits_.hash(row_number, 1)) +
                             0.08 * rods_.at(angle * 6, row * 3.7);
    const double u = across / thickness;
    const double round = u * u < 1.0 ? std::sqrt(1.0 - u * u) : -0.6;
    const double rod = 6.2 * round + 5.0 * wave;
    const double stake_u = 2.6 * (position - std::floor(position + 0.5));
    const double stake =
        stake_u * stake_u < 1.0 ? 5.5 * std::sqrt(1.0 - stake_u * stake_u) - 1.5 : -6.0;
    return rod >= stake ? rod_point(rod, angle, across, row_number)
                        : stake_point(stake, stake_u, v, position);
  }

 private:
  static double half_width(double y) {
    const double t = (y - kRim) / (kFoot - kRim);
    return 186.0 + 90.0 * t * (1.0 - t) - 52.0 * t * t;
  }

  /// A point of strands twisted around an axis.
  /// \param across  -1 .. 1
  /// \param along  units
  [[nodiscard]] SurfacePoint twisted_point(double across, double along, double radius) const {
    const double phase = along / (2.1 * radius) + 0.55 * across;
    const double strand = phase - std::floor(phase);
    const double ridge = std::sqrt(std::max(0.0, 1.0 - 4.0 * (strand - 0.5) * (strand - 0.5)));
    const double fibre = fibres_.ridged(strand * 4.0, along / 40, 2);
    const double tone =
        traits_.value(traits_.hash(static_cast<std::int64_t>(std::floor(phase)), 5));
    SurfacePoint point;
    point.height_px =
        radius * (0.75 * std::sqrt(std::max(0.0, 1.0 - across * across)) + 0.38 * ridge) +
        0.7 * fibre;
    point.albedo = 0.42 + 0.2 * tone + 0.14 * fibre - 0.12 * (1.0 - ridge);
    return point;
  }

  [[nodiscard]] ObjectPoint rim_point(double x, double y) const {
    constexpr double kRadius = 13.0;
    const double across_body = (x - kMiddle) / 194.0;
    if (std::abs(across_body) >= 1.0) return {};
    const double axis = kRim + 14.0 * std::sqrt(1.0 - across_body * across_body) - 8.0;
    const double across = (y - axis) / kRadius;
    if (std::abs(across) >= 1.0) return {};
    const double angle = std::asin(across_body);
    ObjectPoint point{true, twisted_point(across, 190.0 * angle, kRadius)};
    point.surface.height_px += kBulge * std::cos(angle) + 4.0;
    return point;
  }

  [[nodiscard]] ObjectPoint handle_point(double x, double y) const {
    constexpr double kRadius = 9.5;
    const double dx = (x - kMiddle) / 150.0;
    const double dy = (y - kRim) / 108.0;
    const double r = std::sqrt(dx * dx + dy * dy);
    const double across = (r - 1.0) * 128.0 / kRadius;
    if (dy > 0.0 || std::abs(across) >= 1.0) return {};
    ObjectPoint point{true, twisted_point(across, 130.0 * std::atan2(dy, dx), kRadius)};
    point.surface.height_px += 46.0;
    return point;
  }

  [[nodiscard]] ObjectPoint body_point(double x, double y) const {
    if (y < kRim || y > kFoot + 16.0) return {};
    const double t = (x - kMiddle) / half_width(std::min(y, kFoot));
    if (std::abs(t) >= 0.995) return {};
    const double front = std::sqrt(1.0 - t * t);
    const double v = y - 14.0 * front;  // rows sag towards the viewer
    if (v > kFoot - 8.0) return {};
    const double angle = std::asin(t);
    ObjectPoint point{true, weave_point(angle, v)};
    point.surface.height_px += kBulge * front;
    return point;
  }

  [[nodiscard]] SurfacePoint rod_point(double height, double angle, double across,
                                       std::int64_t row) const {
    const double along = angle * 190.0;
    const auto offset = static_cast<double>(row) * 5.3;
    const double fibre = fibres_.ridged(across * 1.6 + offset, along / 55, 3);
    const double tone =
        traits_.value(traits_.hash(row, 2)) - 0.5 + rods_.fractal(along / 45, offset, 2);
    return {height + 0.9 * fibre, std::clamp(0.45 + 0.17 * tone + 0.20 * (fibre - 0.5), 0.08, 1.0)};
  }

  [[nodiscard]] SurfacePoint stake_point(double height, double across, double v,
                                         double position) const {
    const double offset = 3.1 * std::floor(position + 0.5);
    const double fibre = fibres_.ridged(across * 1.3 + offset, v / 50, 3);
    return {std::max(height, -5.0) + 0.8 * fibre, 0.30 + 0.18 * fibre};
  }

  Noise sway_;
  Noise rods_;
  Noise fibres_;
  Lattice traits_;
};

}  // namespace

GreyImage make_basket(const Specimen& specimen, int size_px) {
  const Lamp lamp{{-0.5, -0.55, 0.8}, 0.34, 70.0, 4.0, 9.0, 0.78};
  return draw_object(specimen, size_px, Basket(specimen.noise_seed()), lamp, {112.0});
}

GreyImage make_wicker(const Specimen& specimen, int size_px) {
  constexpr double kUnitsPerRadian = 190.0;
  const Basket basket(specimen.noise_seed());
  const Noise bulge(specimen.noise_seed(), "wicker/bulge");
  const double stakes = specimen.factor("wicker/stakes", 0.15);
  // Stakes are not quite upright or evenly spaced, and the wall bulges.
  const auto wall = [&](double x, double y) {
    const double u = x + 13.0 * bulge.fractal(x / 75, y / 260, 2);
    const double v = y + 13.0 * bulge.fractal(x / 210 + 20, y / 170, 2);
    SurfacePoint point = basket.weave_point(stakes * u / kUnitsPerRadian, v);
    point.height_px += 9.0 * bulge.fractal(x / 120 + 50, y / 120, 2);
    return point;
  };
  View view = view_of(specimen, {0.18, 0.08, 0.2});
  view.scale *= 1.3;
  const Lamp lamp{{-0.5, -0.55, 0.8}, 0.34, 40.0, 4.0, 9.0};
  return draw_surface(specimen, size_px, wall, view, lamp, {118.0});
}

}  // namespace touchtrial::stimuli
