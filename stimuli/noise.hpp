/// \file Gradient noise and cellular noise, identical on every machine for the same seed. Sources:
/// K. Perlin, "Improving noise", 2002; S. Worley, "A cellular texture basis function", 1996. Uses
/// only additions, products and square roots, which all processors round identically.
#pragma once

#include "core/vec.hpp"

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

namespace touchtrial::stimuli {

/// A hashed lattice of random numbers, with a period of 1024 cells.
class Lattice {
 public:
  Lattice(std::uint64_t seed, std::string_view purpose);

  /// A whole number in [0, kSize) for a lattice point; the same point gives the same number.
  [[nodiscard]] std::uint32_t hash(std::int64_t x, std::int64_t y) const noexcept;
  /// A number in [0, 1) for a hash.
  [[nodiscard]] double value(std::uint32_t hash) const noexcept { return values_[hash & kMask]; }
  /// A vector of length 1 for a hash.
  [[nodiscard]] Vec2 direction(std::uint32_t hash) const noexcept {
    return directions_[hash & kMask];
  }

  static constexpr std::uint32_t kSize = 1024;
  static constexpr std::uint32_t kMask = kSize - 1;

 private:
  std::vector<std::uint32_t> order_;
  std::vector<double> values_;
  std::vector<Vec2> directions_;
};

/// Gradient noise with features about one unit wide, mean 0, roughly within -1 .. 1. Thread-safe.
class Noise {
 public:
  Noise(std::uint64_t seed, std::string_view purpose) : lattice_(seed, purpose) {}

  [[nodiscard]] double at(double x, double y) const noexcept;
  /// A sum of octaves, each with half the width and half the strength of the previous one.
  [[nodiscard]] double fractal(double x, double y, int octaves) const noexcept;
  /// The same with sharp crests: 1 on a crest, about 0 between crests.
  [[nodiscard]] double ridged(double x, double y, int octaves) const noexcept;

 private:
  Lattice lattice_;
};

/// The position of a point among cells about one unit wide.
struct CellPosition {
  double to_centre = 0.0;  ///< distance to the nearest centre
  double to_border = 0.0;  ///< distance to the second nearest, minus to_centre; 0 on a border
  std::uint32_t cell = 0;  ///< random number of the cell, in [0, Lattice::kSize)
};

/// Irregular cells around jittered lattice points. Thread-safe.
class Cells {
 public:
  /// \param jitter  0: a square grid; 1: centres anywhere in their square
  Cells(std::uint64_t seed, std::string_view purpose, double jitter = 0.9)
      : lattice_(seed, purpose), jitter_(jitter) {}

  [[nodiscard]] CellPosition at(double x, double y) const noexcept;
  /// A number in [0, 1) for each cell and trait.
  [[nodiscard]] double value(std::uint32_t cell, std::uint32_t trait = 0) const noexcept {
    return lattice_.value(cell * 7 + trait * 131);
  }

 private:
  Lattice lattice_;
  double jitter_;
};

/// 0 up to `start`, 1 from `end`, smooth in between; `end` may be smaller than `start`.
[[nodiscard]] constexpr double smooth_step(double start, double end, double x) noexcept {
  const double t = std::clamp((x - start) / (end - start), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// Linear interpolation: `start` at t = 0, `end` at t = 1.
[[nodiscard]] constexpr double mix(double start, double end, double t) noexcept {
  return start + (end - start) * t;
}

}  // namespace touchtrial::stimuli
