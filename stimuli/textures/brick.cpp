#include "stimuli/noise.hpp"
#include "stimuli/recipes.hpp"
#include "stimuli/relief.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::stimuli {
namespace {

constexpr double kBrickLength = 128.0;  ///< with a joint
constexpr double kCourse = 47.0;        ///< height of a brick and a joint

/// The place of a point in its brick.
struct BrickPlace {
  double inside = 0.0;  ///< distance to the nearest edge, pixels; negative in the joint
  std::uint32_t brick = 0;
  Vec2 local;  ///< from the brick's centre
};

class BrickWall {
 public:
  explicit BrickWall(const Specimen& specimen)
      : traits_(specimen.noise_seed(), "brick/traits"),
        edges_(specimen.noise_seed(), "brick/edges"),
        face_(specimen.noise_seed(), "brick/face"),
        grains_(specimen.noise_seed(), "brick/grains"),
        pits_(specimen.noise_seed(), "brick/pits"),
        length_(kBrickLength * specimen.factor("brick/length", 0.12)),
        mortar_(-8.0 * specimen.factor("brick/mortar", 0.5)),
        roughness_(specimen.factor("brick/roughness", 0.35)),
        pitted_(0.17 * specimen.factor("brick/pitted", 0.8)),
        tones_(0.26 * specimen.factor("brick/tones", 0.4)) {}

  [[nodiscard]] SurfacePoint operator()(double x, double y) const {
    const BrickPlace place = locate(x, y);
    const double joint = mortar_height(x, y);
    const double brick = brick_height(place, x, y);
    const double blend =
        smooth_step(-1.2, 1.0, place.inside + 1.6 * edges_.fractal(x / 5, y / 5, 2));
    SurfacePoint point;
    point.height_px = mix(joint, brick, blend);
    point.albedo =
        std::clamp(mix(mortar_albedo(x, y), brick_albedo(place, x, y), blend), 0.05, 1.0);
    return point;
  }

 private:
  [[nodiscard]] double trait(std::uint32_t brick, std::uint32_t which) const {
    return traits_.value(brick * 7 + which * 131);
  }

  [[nodiscard]] BrickPlace locate(double x, double y) const {
    // Courses are slightly wavy and tilted.
    const double wy = y + 0.018 * x + 20.0 + 2.0 * edges_.fractal(x / 90, y / 90, 2);
    const double wx = x - 0.012 * y + 1.8 * edges_.fractal(x / 70 + 40, y / 70, 2);
    auto row_number = static_cast<std::int64_t>(std::floor(wy / kCourse));
    if (wy < bed(row_number)) --row_number;
    if (wy >= bed(row_number + 1)) ++row_number;
    const double shift = 0.5 * static_cast<double>(row_number & 1) +
                         0.14 * (traits_.value(traits_.hash(row_number, 77)) - 0.5);
    const double along = wx / length_ + shift;
    auto column = static_cast<std::int64_t>(std::floor(along));
    if (along < head(column, row_number)) --column;
    if (along >= head(column + 1, row_number)) ++column;
    const double left = head(column, row_number);
    const double right = head(column + 1, row_number);
    const double top = bed(row_number);
    const double bottom = bed(row_number + 1);
    BrickPlace place;
    place.brick = traits_.hash(column, row_number);
    place.local = {(along - (left + right) / 2) * length_, wy - (top + bottom) / 2};
    const double joint_x = 3.6 + 2.2 * trait(place.brick, 1);
    const double joint_y = 3.4 + 1.6 * trait(place.brick, 2);
    const double tilt = 0.02 * (trait(place.brick, 3) - 0.5);
    const double dx = (right - left) / 2 * length_ - joint_x -
                      std::abs(place.local.x + 3.0 * (trait(place.brick, 4) - 0.5));
    const double dy =
        (bottom - top) / 2 - joint_y -
        std::abs(place.local.y + tilt * place.local.x + 1.6 * (trait(place.brick, 5) - 0.5));
    place.inside = rounded_corner(dx, dy);
    return place;
  }

  /// Middle of the joint above a course; courses differ in height.
  [[nodiscard]] double bed(std::int64_t row) const {
    return kCourse *
           (static_cast<double>(row) + 0.11 * (traits_.value(traits_.hash(row, 91)) - 0.5));
  }
  /// Middle of the joint to the left of a brick, in bricks.
  [[nodiscard]] double head(std::int64_t column, std::int64_t row) const {
    return static_cast<double>(column) +
           0.10 * (traits_.value(traits_.hash(column + 37, row + 53)) - 0.5);
  }

  /// Distance to a rectangle's edge, with corners of 6 pixels' radius.
  static double rounded_corner(double dx, double dy) {
    constexpr double kRadius = 6.0;
    if (dx >= kRadius || dy >= kRadius) return std::min(dx, dy);
    const double ax = kRadius - dx;
    const double ay = kRadius - dy;
    return kRadius - std::sqrt(ax * ax + ay * ay);
  }

  [[nodiscard]] double mortar_height(double x, double y) const {
    return mortar_ + 2.2 * face_.fractal(x / 11, y / 11, 3) +
           1.5 * grains_.fractal(x / 2.6, y / 2.6, 2);
  }

  [[nodiscard]] double mortar_albedo(double x, double y) const {
    return 0.62 + 0.22 * grains_.fractal(x / 2.4 + 7, y / 2.4, 2) +
           0.12 * face_.fractal(x / 20, y / 20, 2);
  }

  [[nodiscard]] double brick_height(const BrickPlace& place, double x, double y) const {
    const double own = 40.0 * trait(place.brick, 6);
    const double tilt = 0.04 * (trait(place.brick, 8) - 0.5) * place.local.x;
    return 3.0 * smooth_step(0.0, 5.0, place.inside) + 2.0 * (trait(place.brick, 7) - 0.5) + tilt +
           2.4 * roughness_ * face_.fractal(x / 17 + own, y / 13, 4) +
           1.8 * roughness_ * face_.ridged(x / 26 + own, y / 9 + own, 3) +
           0.9 * grains_.fractal(x / 2.8, y / 2.8, 2) - pit_depth(x + 9.0 * own, y);
  }

  /// Some cells of the face have a pit, each of its own size.
  [[nodiscard]] double pit_depth(double x, double y) const {
    const CellPlace pit = pits_.at(x / 9.0, y / 7.5);
    if (pits_.value(pit.cell) >= pitted_) return 0.0;
    const double size = 0.12 + 0.42 * pits_.value(pit.cell, 1);
    return 3.2 * smooth_step(size, 0.4 * size, pit.to_centre + 0.25 * edges_.at(x / 3, y / 3));
  }

  [[nodiscard]] double brick_albedo(const BrickPlace& place, double x, double y) const {
    const double own = 40.0 * trait(place.brick, 6);
    const double burnt = smooth_step(0.25, 0.6, face_.fractal(x / 45 + own, y / 35, 2));
    return 0.30 + tones_ * trait(place.brick, 9) + 0.10 * face_.fractal(x / 9, y / 9 + own, 3) +
           0.14 * grains_.fractal(x / 2.2, y / 2.2, 2) - 0.12 * burnt;
  }

  Lattice traits_;
  Noise edges_;
  Noise face_;
  Noise grains_;
  Cells pits_;
  double length_;     ///< of a brick and a joint, pixels
  double mortar_;     ///< height of the joints, pixels
  double roughness_;  ///< of the faces, relative
  double pitted_;     ///< share of the cells of a face that hold a pit
  double tones_;      ///< spread of the bricks' lightness
};

}  // namespace

GreyImage make_brick(const Specimen& specimen, int size_px) {
  const Lamp lamp{{-0.5, -0.66, 0.6}, 0.34, 26.0, 2.5, 8.0};
  return surface_picture(specimen, size_px, BrickWall(specimen),
                         view_of(specimen, {0.18, 0.05, 0.15}), lamp, {116.0, 0.92});
}

}  // namespace touchtrial::stimuli
