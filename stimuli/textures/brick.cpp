#include "stimuli/noise.hpp"
#include "stimuli/recipes.hpp"
#include "stimuli/relief.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::stimuli {
namespace {

constexpr double kBrickLength = 128.0;  ///< with a joint
constexpr double kCourse = 47.0;        ///< height of a brick and a joint

/// The position of a point in its brick.
struct BrickPosition {
  double edge_distance = 0.0;  ///< distance to the nearest edge, pixels; negative in the joint
  std::uint32_t brick = 0;
  Vec2 centre_offset;  ///< from the brick's centre
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
        pit_share_(0.17 * specimen.factor("brick/pitted", 0.8)),
        tone_spread_(0.26 * specimen.factor("brick/tones", 0.4)) {}

  [[nodiscard]] SurfacePoint operator()(double x, double y) const {
    const BrickPosition position = locate(x, y);
    const double joint = mortar_height(x, y);
    const double brick = brick_height(position, x, y);
    const double blend =
        smooth_step(-1.2, 1.0, position.edge_distance + 1.6 * edges_.fractal(x / 5, y / 5, 2));
    SurfacePoint point;
    point.height_px = mix(joint, brick, blend);
    point.albedo =
        std::clamp(mix(mortar_albedo(x, y), brick_albedo(position, x, y), blend), 0.05, 1.0);
    return point;
  }

 private:
  [[nodiscard]] double trait(std::uint32_t brick, std::uint32_t index) const {
    return traits_.value(brick * 7 + index * 131);
  }

  [[nodiscard]] BrickPosition locate(double x, double y) const {
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
    BrickPosition position;
    position.brick = traits_.hash(column, row_number);
    position.centre_offset = {(along - (left + right) / 2) * length_, wy - (top + bottom) / 2};
    const double joint_x = 3.6 + 2.2 * trait(position.brick, 1);
    const double joint_y = 3.4 + 1.6 * trait(position.brick, 2);
    const double tilt = 0.02 * (trait(position.brick, 3) - 0.5);
    const double dx = (right - left) / 2 * length_ - joint_x -
                      std::abs(position.centre_offset.x + 3.0 * (trait(position.brick, 4) - 0.5));
    const double dy = (bottom - top) / 2 - joint_y -
                      std::abs(position.centre_offset.y + tilt * position.centre_offset.x +
                               1.6 * (trait(position.brick, 5) - 0.5));
    position.edge_distance = rounded_corner(dx, dy);
    return position;
  }

  /// Middle of the joint above a course. Courses differ in height.
  [[nodiscard]] double bed(std::int64_t row) const {
    return kCourse *
           (static_cast<double>(row) + 0.11 * (traits_.value(traits_.hash(row, 91)) - 0.5));
  }
  /// Middle of the joint to the left of a brick, in bricks.
  [[nodiscard]] double head(std::int64_t column, std::int64_t row) const {
    return static_cast<double>(column) +
           0.10 * (traits_.value(traits_.hash(column + 37, row + 53)) - 0.5);
  }

  /// Distance to the edge of a rectangle with a corner radius of 6 pixels.
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

  [[nodiscard]] double brick_height(const BrickPosition& position, double x, double y) const {
    const double offset = 40.0 * trait(position.brick, 6);
    const double tilt = 0.04 * (trait(position.brick, 8) - 0.5) * position.centre_offset.x;
    return 3.0 * smooth_step(0.0, 5.0, position.edge_distance) +
           2.0 * (trait(position.brick, 7) - 0.5) + tilt +
           2.4 * roughness_ * face_.fractal(x / 17 + offset, y / 13, 4) +
           1.8 * roughness_ * face_.ridged(x / 26 + offset, y / 9 + offset, 3) +
           0.9 * grains_.fractal(x / 2.8, y / 2.8, 2) - pit_depth(x + 9.0 * offset, y);
  }

  /// Some cells of the face have a pit, each of random size.
  [[nodiscard]] double pit_depth(double x, double y) const {
    const CellPosition pit = pits_.at(x / 9.0, y / 7.5);
    if (pits_.value(pit.cell) >= pit_share_) return 0.0;
    const double size = 0.12 + 0.42 * pits_.value(pit.cell, 1);
    return 3.2 * smooth_step(size, 0.4 * size, pit.to_centre + 0.25 * edges_.at(x / 3, y / 3));
  }

  [[nodiscard]] double brick_albedo(const BrickPosition& position, double x, double y) const {
    const double offset = 40.0 * trait(position.brick, 6);
    const double burn = smooth_step(0.25, 0.6, face_.fractal(x / 45 + offset, y / 35, 2));
    return 0.30 + tone_spread_ * trait(position.brick, 9) +
           0.10 * face_.fractal(x / 9, y / 9 + offset, 3) +
           0.14 * grains_.fractal(x / 2.2, y / 2.2, 2) - 0.12 * burn;
  }

  Lattice traits_;
  Noise edges_;
  Noise face_;
  Noise grains_;
  Cells pits_;
  double length_;       ///< of a brick and a joint, pixels
  double mortar_;       ///< height of the joints, pixels
  double roughness_;    ///< of the faces, relative
  double pit_share_;    ///< share of a face's cells with a pit
  double tone_spread_;  ///< spread of the bricks' lightness
};

}  // namespace

GreyImage make_brick(const Specimen& specimen, int size_px) {
  const Lamp lamp{{-0.5, -0.66, 0.6}, 0.34, 26.0, 2.5, 8.0};
  return draw_surface(specimen, size_px, BrickWall(specimen), view_of(specimen, {0.18, 0.05, 0.15}),
                      lamp, {116.0, 0.92});
}

}  // namespace touchtrial::stimuli
