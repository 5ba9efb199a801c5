#include "stimuli/noise.hpp"

#include "core/random.hpp"

#include <cmath>
#include <numeric>

namespace touchtrial::stimuli {
namespace {

/// Avoids sine and cosine, whose last digit differs between libraries.
Vec2 random_direction(RandomStream& random) {
  while (true) {
    const Vec2 v{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
    const double squared = v.x * v.x + v.y * v.y;
    if (squared > 0.01 && squared <= 1.0) return (1.0 / std::sqrt(squared)) * v;
  }
}

double fade(double t) {
  return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

}  // namespace

Lattice::Lattice(std::uint64_t seed, std::string_view purpose)
    : order_(kSize), values_(kSize), directions_(kSize) {
  RandomStream random(seed, purpose);
  std::iota(order_.begin(), order_.end(), 0U);
  shuffle(std::span(order_), random);
  for (double& value : values_) value = random.uniform();
  for (Vec2& direction : directions_) direction = random_direction(random);
}

std::uint32_t Lattice::hash(std::int64_t x, std::int64_t y) const noexcept {
  const auto column = static_cast<std::uint32_t>(x) & kMask;
  const auto row = static_cast<std::uint32_t>(y) & kMask;
  return order_[(order_[column] + row) & kMask];
}

double Noise::at(double x, double y) const noexcept {
  const double left = std::floor(x);
  const double top = std::floor(y);
  const auto corner = [&](int right, int down) {
    const Vec2 slope = lattice_.direction(lattice_.hash(static_cast<std::int64_t>(left) + right,
                                                        static_cast<std::int64_t>(top) + down));
    return slope.x * (x - left - right) + slope.y * (y - top - down);
  };
  const double u = fade(x - left);
  return 1.5 *
         mix(mix(corner(0, 0), corner(1, 0), u), mix(corner(0, 1), corner(1, 1), u), fade(y - top));
}

double Noise::fractal(double x, double y, int octaves) const noexcept {
  double sum = 0.0;
  double strength = 0.6;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += strength * at(x, y);
    strength *= 0.5;
    // The factor is slightly off two, and there is a shift, so that lattices of octaves never
    // align.
    x = 2.03 * x + 17.3;
    y = 2.03 * y + 31.7;
  }
  return sum;
}

double Noise::ridged(double x, double y, int octaves) const noexcept {
  double sum = 0.0;
  double strength = 0.5;
  double total = 0.0;
  for (int octave = 0; octave < octaves; ++octave) {
    const double crest = 1.0 - std::abs(at(x, y));
    sum += strength * crest * crest;
    total += strength;
    strength *= 0.5;
    x = 2.03 * x + 11.9;
    y = 2.03 * y + 47.1;
  }
  return sum / total;
}

CellPosition Cells::at(double x, double y) const noexcept {
  const double column = std::floor(x);
  const double row = std::floor(y);
  CellPosition position;
  double nearest_squared = 1e9;
  double second_squared = 1e9;
  for (int down = -2; down <= 2; ++down) {
    for (int right = -2; right <= 2; ++right) {
      const std::uint32_t hash = lattice_.hash(static_cast<std::int64_t>(column) + right,
                                               static_cast<std::int64_t>(row) + down);
      const double dx = column + right + 0.5 + jitter_ * (lattice_.value(hash) - 0.5) - x;
      const double dy = row + down + 0.5 + jitter_ * (lattice_.value(hash * 5 + 3) - 0.5) - y;
      const double squared = dx * dx + dy * dy;
      if (squared < nearest_squared) {
        second_squared = nearest_squared;
        nearest_squared = squared;
        position.cell = hash;
      } else if (squared < second_squared) {
        second_squared = squared;
      }
    }
  }
  position.to_centre = std::sqrt(nearest_squared);
  position.to_border = std::sqrt(second_squared) - position.to_centre;
  return position;
}

}  // namespace touchtrial::stimuli
