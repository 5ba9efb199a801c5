/// \file One piece of a material, and how it came before the camera.
#pragma once

#include "core/vec.hpp"

#include <cstdint>
#include <string_view>

namespace touchtrial::stimuli {

/// The pieces of one seed: exemplar 1 is as its recipe describes it; each further one has noise of
/// its own and departs from the recipe as photographs of one material depart from each other.
/// The same seed and exemplar are the same piece. Thread-safe.
class Specimen {
 public:
  /// \param exemplar  from 1
  explicit Specimen(std::uint64_t seed, int exemplar = 1);

  /// Seed of this piece's noise.
  [[nodiscard]] std::uint64_t noise_seed() const noexcept { return noise_seed_; }

  /// A departure between -spread and spread, 0 for exemplar 1. Successive exemplars are spread
  /// evenly, so that five of them cover the range.
  [[nodiscard]] double shift(std::string_view trait, double spread) const;
  /// A factor between 1 / (1 + spread) and 1 + spread, 1 for exemplar 1.
  [[nodiscard]] double factor(std::string_view trait, double spread) const;
  /// The direction along x, turned by up to about `spread` radians either way.
  [[nodiscard]] Vec2 turn(std::string_view trait, double spread) const;

 private:
  std::uint64_t seed_;
  std::uint64_t noise_seed_;
  int exemplar_;
};

/// Where the camera stands.
struct View {
  double scale = 1.0;     ///< pixels that a pixel of the recipe takes
  Vec2 along{1.0, 0.0};   ///< the picture's x on the surface, length 1
  double relief = 1.0;    ///< how much of the recipe's depth there is: worn below 1
  Vec2 middle{0.0, 0.0};  ///< point that scaling and turning leave in place, pixels

  /// The point of the surface that is seen at a pixel coordinate.
  [[nodiscard]] Vec2 on_surface(double x_px, double y_px) const noexcept {
    const double x = x_px - middle.x;
    const double y = y_px - middle.y;
    return {middle.x + (along.x * x - along.y * y) / scale,
            middle.y + (along.y * x + along.x * y) / scale};
  }
};

/// How far the views of a material's pieces lie apart.
struct ViewSpread {
  double scale = 0.2;
  double turn = 0.1;
  double relief = 0.2;
};

[[nodiscard]] View view_of(const Specimen& specimen, const ViewSpread& spread = {});

}  // namespace touchtrial::stimuli
