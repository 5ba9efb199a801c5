#include "core/random.hpp"
#include "stimuli/noise.hpp"
#include "stimuli/recipes.hpp"
#include "stimuli/relief.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace touchtrial::stimuli {
namespace {

struct Pebble {
  Vec2 centre_px;
  double radius_px = 0.0;
  Vec2 long_axis{1.0, 0.0};
  double slenderness = 1.0;  ///< long half-axis over the short one
  double base_px = 0.0;      ///< height of its base
  double flatness = 0.7;     ///< height of its dome over its radius
  double albedo = 0.5;
  double noise_offset = 0.0;  ///< random offset in the noise
};

Pebble random_pebble(RandomStream& random, double radius_px, double size_px, double base_px) {
  Pebble pebble;
  pebble.centre_px = {random.uniform(-radius_px, size_px + radius_px),
                      random.uniform(-radius_px, size_px + radius_px)};
  pebble.radius_px = radius_px;
  const Vec2 axis{random.uniform(-1.0, 1.0), random.uniform(0.05, 1.0)};
  pebble.long_axis = (1.0 / std::sqrt(axis.x * axis.x + axis.y * axis.y)) * axis;
  pebble.slenderness = random.uniform(1.0, 1.55);
  pebble.base_px = base_px;
  pebble.flatness = random.uniform(0.45, 0.8);
  const double tone = random.uniform();
  pebble.albedo = 0.3 + 0.5 * tone;
  pebble.noise_offset = random.uniform(0.0, 500.0);
  return pebble;
}

/// One size of pebbles, and the number of attempts to place them. Larger pebbles are placed first.
struct Layer {
  double radius_px;
  double base_px;
  int tries_per_megapixel;
};
constexpr Layer kLayers[] = {{33.0, 7.0, 300},  {25.0, 5.0, 900},   {18.0, 3.0, 3000},
                             {12.5, 1.0, 9000}, {8.5, -2.0, 22000}, {5.5, -5.0, 50000},
                             {3.6, -7.0, 90000}};

/// The share of pebbles above this radius varies between specimens.
constexpr double kLargeRadius_px = 20.0;

/// The placed pebbles, indexed by grid square.
class Heap {
 public:
  explicit Heap(double size_px)
      : columns_(static_cast<int>((size_px + 2 * kMargin) / kSquare) + 1),
        squares_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(columns_)) {}

  /// Adds the pebble unless it overlaps others too much.
  void add_if_free(const Pebble& pebble) {
    const int column = square_of(pebble.centre_px.x);
    const int row = square_of(pebble.centre_px.y);
    for (int dy = -kReach; dy <= kReach; ++dy) {
      for (int dx = -kReach; dx <= kReach; ++dx) {
        if (collides(pebble, column + dx, row + dy)) return;
      }
    }
    squares_[index(column, row)].push_back(pebbles_.size());
    pebbles_.push_back(pebble);
  }
  [[nodiscard]] const std::vector<Pebble>& pebbles() const { return pebbles_; }

 private:
  static constexpr double kSquare = 30.0;
  static constexpr double kMargin = 50.0;
  static constexpr int kReach = 3;

  [[nodiscard]] int square_of(double coordinate) const {
    return std::clamp(static_cast<int>((coordinate + kMargin) / kSquare), 0, columns_ - 1);
  }
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  [[nodiscard]] bool collides(const Pebble& pebble, int column, int row) const {
    if (column < 0 || row < 0 || column >= columns_ || row >= columns_) return false;
    const auto& square = squares_[index(column, row)];
    return std::any_of(square.begin(), square.end(), [&](std::size_t i) {
      const Vec2 d = pebbles_[i].centre_px - pebble.centre_px;
      const double min_distance = 0.92 * (pebbles_[i].radius_px + pebble.radius_px);
      return d.x * d.x + d.y * d.y < min_distance * min_distance;
    });
  }

  int columns_;
  std::vector<std::vector<std::size_t>> squares_;
  std::vector<Pebble> pebbles_;
};

std::vector<Pebble> heap_of_pebbles(const Specimen& specimen, int size_px) {
  const double scale = specimen.factor("view/scale", 0.25);
  const double relief = scale * specimen.factor("view/relief", 0.2);
  const double large_share = specimen.factor("pebbles/large", 1.5);
  RandomStream random(specimen.noise_seed(), "pebbles/places");
  Heap heap(size_px);
  for (const Layer& layer : kLayers) {
    const double side = size_px / scale + 2 * layer.radius_px;
    const double share = layer.radius_px > kLargeRadius_px ? large_share : 1.0;
    const int tries = static_cast<int>(share * side * side * 1e-6 * layer.tries_per_megapixel) + 1;
    for (int i = 0; i < tries; ++i) {
      const double radius = scale * layer.radius_px * random.uniform(0.8, 1.2);
      const double base = relief * (layer.base_px + random.uniform(-2.0, 2.0));
      Pebble pebble = random_pebble(random, radius, size_px, base);
      pebble.flatness *= relief / scale;
      heap.add_if_free(pebble);
    }
  }
  return heap.pebbles();
}

class PebblePainter {
 public:
  PebblePainter(std::uint64_t seed, Relief& relief)
      : outline_(seed, "pebbles/outline"), mottle_(seed, "pebbles/mottle"), relief_(relief) {}

  void paint_sand() {
    fill(relief_, [&](double x, double y) {
      const double grain = mottle_.fractal(x / 3.0, y / 3.0, 3);
      return SurfacePoint{-14.0 + 2.5 * grain, 0.32 + 0.2 * grain};
    });
  }

  void paint(const Pebble& pebble) {
    const double reach = pebble.radius_px * 1.7;
    const int last = relief_.side() - 1;
    const int top = std::max(0, px_to_grid(pebble.centre_px.y - reach));
    const int bottom = std::min(last, px_to_grid(pebble.centre_px.y + reach));
    const int left = std::max(0, px_to_grid(pebble.centre_px.x - reach));
    const int right = std::min(last, px_to_grid(pebble.centre_px.x + reach));
    for (int y = top; y <= bottom; ++y) {
      for (int x = left; x <= right; ++x) paint_point(pebble, y, x);
    }
  }

 private:
  void paint_point(const Pebble& pebble, int y, int x) {
    const Vec2 d = Vec2{grid_to_px(x), grid_to_px(y)} - pebble.centre_px;
    const double stretch = std::sqrt(pebble.slenderness);
    const double u = (d.x * pebble.long_axis.x + d.y * pebble.long_axis.y) / stretch;
    const double v = (d.y * pebble.long_axis.x - d.x * pebble.long_axis.y) * stretch;
    const double scale = pebble.radius_px;
    const double dent = 0.16 * outline_.fractal(u / scale + pebble.noise_offset, v / scale, 2);
    const double r2 = (u * u + v * v) / (scale * scale * (1.06 + dent) * (1.06 + dent));
    if (r2 >= 1.0) return;
    const double dome = std::sqrt(1.0 - r2);
    const double height =
        pebble.base_px + pebble.flatness * scale * (0.65 * dome + 0.35 * (1 - r2 * r2)) +
        0.9 * mottle_.fractal(d.x / 6 + pebble.noise_offset, d.y / 6, 3) +
        0.10 * scale * outline_.at(u / scale * 1.7, v / scale * 1.7 + pebble.noise_offset);
    if (height <= relief_.height_px.at(y, x)) return;
    relief_.height_px.at(y, x) = height;
    relief_.albedo.at(y, x) = albedo(pebble, d, u, v);
  }

  /// Lightness with speckles, and a vein on some pebbles.
  [[nodiscard]] double albedo(const Pebble& pebble, Vec2 d, double u, double v) const {
    const double speckle = mottle_.fractal(d.x / 2.3 + pebble.noise_offset, d.y / 2.3, 2);
    const double cloud = mottle_.fractal(d.x / 14, d.y / 14 + pebble.noise_offset, 2);
    const double line =
        v / pebble.radius_px - 0.3 + 0.3 * outline_.at(u / 12 + pebble.noise_offset, 0.5);
    const double streak = pebble.noise_offset < 110.0 && std::abs(line) < 0.09 ? 0.22 : 0.0;
    return std::clamp(pebble.albedo + 0.16 * speckle + 0.14 * cloud + streak, 0.08, 1.0);
  }

  Noise outline_;
  Noise mottle_;
  Relief& relief_;
};

}  // namespace

GreyImage make_pebbles(const Specimen& specimen, int size_px) {
  Relief relief(size_px);
  PebblePainter painter(specimen.noise_seed(), relief);
  painter.paint_sand();
  for (const Pebble& pebble : heap_of_pebbles(specimen, size_px)) painter.paint(pebble);
  const Lamp lamp{{-0.55, -0.6, 0.7}, 0.34, 40.0, 4.0, 12.0};
  return photograph(specimen, relief, lamp, {118.0, 0.95});
}

}  // namespace touchtrial::stimuli
