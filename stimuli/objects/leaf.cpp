#include "stimuli/noise.hpp"
#include "stimuli/recipes.hpp"
#include "stimuli/relief.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::stimuli {
namespace {

constexpr double kVeinDistance = 40.0;

/// The shape and position of a leaf, units.
struct LeafShape {
  Vec2 foot{68.0, 446.0};
  double length = 560.0;
  double half_width = 188.0;
  double midrib = 5.2;  ///< half thickness at the foot, units
  double arch = 1.0;    ///< relative height of the blade's curvature
};

/// The position of a point on the leaf.
struct LeafPosition {
  double along = 0.0;   ///< from the foot (0) to the tip (1)
  double across = 0.0;  ///< units to the right of the midrib
};

/// The side vein nearest to a point.
struct Vein {
  double distance = 0.0;  ///< units, across the vein
  double number = 0.0;
  double gap_position = 0.0;  ///< 0 on a vein, 1 halfway to the next
};

/// A broad leaf seen from below, with raised veins: midrib, side veins and a net.
class Leaf {
 public:
  explicit Leaf(std::uint64_t seed, const LeafShape& shape = {})
      : shape_(shape),
        sway_(seed, "leaf/sway"),
        blotches_(seed, "leaf/blotches"),
        net_(seed, "leaf/net"),
        mesh_(seed, "leaf/mesh") {}

  [[nodiscard]] ObjectPoint operator()(double x, double y) const {
    const LeafPosition position = locate(x, y);
    if (const ObjectPoint stem = stem_point(position); stem.is_object) return stem;
    if (position.along <= 0.0 || position.along >= 1.0) return {};
    const Vein vein = nearest_vein(position);
    const double tooth = 5.0 * (1.0 - vein.gap_position) * smooth_step(0.0, 0.3, position.along);
    const double edge = half_width(position.along) + tooth + 2.0 * sway_.at(x / 16, y / 16);
    if (std::abs(position.across) >= edge) return {};
    return {true, blade(position, vein, x, y)};
  }

 private:
  [[nodiscard]] LeafPosition locate(double x, double y) const {
    // The leaf lies diagonally, and its midrib is bent.
    constexpr Vec2 kAlong{0.7071067811865476, -0.7071067811865476};
    const Vec2 d{x - shape_.foot.x, y - shape_.foot.y};
    const double s = (d.x * kAlong.x + d.y * kAlong.y) / shape_.length;
    const double across = d.x * -kAlong.y + d.y * kAlong.x;
    const double bend = 62.0 * s * (1.0 - s) + 3.0 * sway_.at(s * 5, 3.3);
    return {s, across + bend - 10.0};
  }

  [[nodiscard]] double half_width(double t) const {
    return shape_.half_width * 2.15 * std::sqrt(t) * (1.0 - t) * (1.0 - 0.25 * t) *
           (1.0 + 0.35 * t);
  }

  [[nodiscard]] Vein nearest_vein(const LeafPosition& position) const {
    const double side = position.across < 0.0 ? -1.0 : 1.0;
    const double reach = std::abs(position.across);
    const double sway = 5.0 * sway_.fractal(position.along * 7 + 20 * side, reach / 60, 2);
    const double lane =
        (shape_.length * position.along - 0.62 * reach - 0.0011 * reach * reach + sway) /
            kVeinDistance +
        0.5 * (side + 1.0) * 0.45;
    Vein vein;
    vein.number = std::floor(lane + 0.5) + 100.0 * side;
    const double offset = lane - std::floor(lane + 0.5);
    vein.distance = kVeinDistance * std::abs(offset) * 0.84;
    vein.gap_position = 2.0 * std::abs(offset);
    return vein;
  }

  [[nodiscard]] ObjectPoint stem_point(const LeafPosition& position) const {
    const double thickness = shape_.midrib - 4.0 * std::clamp(position.along, 0.0, 1.0);
    const double u = position.across / thickness;
    if (position.along < -0.085 || position.along > 0.985 || u * u >= 1.0) return {};
    const double grain = blotches_.fractal(position.across / 2, position.along * 60, 2);
    const double lift = position.along > 0.0 ? arch(position) : 0.0;
    return {
        true,
        {4.0 + lift + 1.3 * thickness * std::sqrt(1.0 - u * u) + 0.3 * grain, 0.62 + 0.08 * grain}};
  }

  /// The curvature of the blade: both halves rise from the midrib and fall towards the edge.
  [[nodiscard]] double arch(const LeafPosition& position) const {
    const double t = std::abs(position.across) / shape_.half_width;
    return shape_.arch *
           (26.0 * position.along * (1.0 - position.along) * 2.0 + 34.0 * t * (0.9 - t));
  }

  [[nodiscard]] SurfacePoint blade(const LeafPosition& position, const Vein& vein, double x,
                                   double y) const {
    const double reach = std::abs(position.across);
    const double taper = 1.0 - 0.7 * std::min(1.0, reach / half_width(position.along));
    const double ridge = smooth_step(3.4 * taper + 0.6, 0.2, vein.distance);
    // The meshes of the net lie between the side veins.
    const double wx = x + 5.0 * sway_.at(x / 20, y / 20);
    const double wy = y + 5.0 * sway_.at(x / 20 + 40, y / 20);
    const CellPosition mesh = mesh_.at(wx / 13, wy / 13);
    const CellPosition fine = net_.at(wx / 5.2, wy / 5.2);
    const double pillow = smooth_step(0.0, 0.55, mesh.to_border);
    const double cushion = smooth_step(0.0, 0.6, fine.to_border);
    const double blotch = blotches_.fractal(x / 38, y / 38, 4);
    SurfacePoint point;
    point.height_px = 4.0 + arch(position) + 5.5 * vein.gap_position + 2.6 * ridge - 2.1 * pillow -
                      0.8 * cushion + 6.0 * blotches_.fractal(x / 70 + 9, y / 70, 2);
    point.albedo = std::clamp(
        0.44 + 0.16 * ridge + 0.11 * (1.0 - pillow) + 0.05 * (1.0 - cushion) + 0.13 * blotch, 0.08,
        1.0);
    return point;
  }

  LeafShape shape_;
  Noise sway_;
  Noise blotches_;
  Cells net_;
  Cells mesh_;
};

}  // namespace

GreyImage make_leaf(const Specimen& specimen, int size_px) {
  const Lamp lamp{{-0.72, -0.42, 0.75}, 0.36, 40.0, 5.0, 9.0, 0.78};
  return draw_object(specimen, size_px, Leaf(specimen.noise_seed()), lamp, {112.0});
}

GreyImage make_venation(const Specimen& specimen, int size_px) {
  // The leaf is so large that its edge is outside the picture.
  LeafShape shape;
  shape.foot = {-780.0 + specimen.shift("venation/foot", 110.0), 1010.0};
  shape.length = 2300.0;
  shape.half_width = 900.0;
  shape.arch = 0.0;
  shape.midrib = 8.6;
  const Leaf leaf(specimen.noise_seed(), shape);
  const Noise bend(specimen.noise_seed(), "venation/bend");
  View view = view_of(specimen, {0.15, 0.25, 0.2});
  view.scale *= 1.35;
  view.relief *= 0.62;
  const auto blade = [&](double x, double y) {
    const double u = x + 8.0 * bend.fractal(x / 150, y / 150, 2);
    const double v = y + 8.0 * bend.fractal(x / 150 + 40, y / 150, 2);
    SurfacePoint point = leaf(u, v).surface;
    point.height_px += 16.0 * bend.fractal(x / 110 + 80, y / 110, 2);
    return point;
  };
  const Lamp lamp{{-0.72, -0.42, 0.75}, 0.36, 30.0, 5.0, 9.0};
  return draw_surface(specimen, size_px, blade, view, lamp, {118.0});
}

}  // namespace touchtrial::stimuli
