/// \file One specimen of a material, and the camera's view of it.
#pragma once

#include "core/vec.hpp"

#include <cstdint>
#include <string_view>

namespace touchtrial::stimuli {

/// One of the specimens of a seed. Exemplar 1 follows its recipe exactly. Further exemplars have
/// other noise and vary like photographs of one material. The same seed and exemplar give the same
/// specimen. Thread-safe.
class Specimen {
 public:
  /// \param exemplar  from 1
  explicit Specimen(std::uint64_t seed, int exemplar = 1);

  /// Seed of this specimen's noise.
  [[nodiscard]] std::uint64_t noise_seed() const noexcept { return noise_seed_; }

  /// A deviation between -spread and spread, 0 for exemplar 1. Successive exemplars are evenly
  /// spread, so that five of them cover the range.
  [[nodiscard]] double shift(std::string_view trait, double spread) const;
  /// A factor between 1 / (1 + spread) and 1 + spread, 1 for exemplar 1.
  [[nodiscard]] double factor(std::string_view trait, double spread) const;
  /// The direction of x, rotated by up to about `spread` radians either way.
  [[nodiscard]] Vec2 turn(std::string_view trait, double spread) const;

 private:
  std::uint64_t seed_;
  std::uint64_t noise_seed_;
  int exemplar_;
};

/// The view of the camera.
struct View {
  double scale = 1.0;          ///< picture pixels per recipe pixel
  Vec2 x_direction{1.0, 0.0};  ///< direction of the picture's x axis on the surface, length 1
  double relief = 1.0;         ///< depth relative to the recipe; below 1: worn
  Vec2 middle{0.0, 0.0};       ///< centre of scaling and rotation, pixels

  /// The point of the surface at a pixel coordinate.
  [[nodiscard]] Vec2 surface_position(double x_px, double y_px) const noexcept {
    const double x = x_px - middle.x;
    const double y = y_px - middle.y;
    return {middle.x + (x_direction.x * x - x_direction.y * y) / scale,
            middle.y + (x_direction.y * x + x_direction.x * y) / scale};
  }
};

/// Spread of the views of specimens, as in Specimen::factor() and Specimen::turn().
struct ViewSpread {
  double scale = 0.2;
  double turn = 0.1;
  double relief = 0.2;
};

[[nodiscard]] View view_of(const Specimen& specimen, const ViewSpread& spread = {});

}  // namespace touchtrial::stimuli
