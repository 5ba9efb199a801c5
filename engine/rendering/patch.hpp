/// \file Sums over the 4 x 4 heights around a point, the inner loop of both rendering models,
/// vectorised for every target.
#pragma once

#include "core/vec.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace touchtrial::engine {

/// The result of a sum: a value, and its gradient or a force.
struct PatchSums {
  double value = 0.0;
  double along_x = 0.0;  ///< per pixel
  double along_y = 0.0;  ///< per pixel
};

/// A sum over a patch. Results are identical for all instruction sets: the order of additions is
/// fixed, and no multiply-add is fused. No allocation, lock or exception. Thread-safe.
/// \param corner  the first height of the first row
/// \param stride  distance of two rows, in heights
/// \param u,v  position between the second and third column, and row, 0 to 1
using SumOfPatch = PatchSums (*)(const float* corner, std::size_t stride, double u, double v);

/// Height and tangential force (neighbourhood of 3; docs/method.md, "Force field") interpolated
/// bilinearly between the four central pixels. A pixel's own height cancels in each pair of
/// opposite neighbours, so the force is [1 2 1] / 2 across and [1 0 -1] along its component.
/// \throws Error if Highway's library, loaded by the first call, cannot be loaded
[[nodiscard]] SumOfPatch bilinear_sum();

/// Value and gradient of the cubic B-spline whose coefficients are the heights.
/// \throws Error as bilinear_sum
[[nodiscard]] SumOfPatch spline_sum();

/// The 4 x 4 patches of a plane. Points in the outer pixels have none.
class Patches {
 public:
  /// An empty set: no point has a patch.
  Patches() = default;
  /// \param heights  row-major, height_px x width_px; must outlive this object
  Patches(std::span<const float> heights, int height_px, int width_px, SumOfPatch sum) noexcept
      : heights_(heights.data()),
        stride_(static_cast<std::size_t>(width_px)),
        end_px_{width_px - 2.0, height_px - 2.0},
        sum_(sum) {}

  /// \param px  in continuous pixel coordinates; pixel centres are whole numbers
  [[nodiscard]] bool has(Vec2 px) const noexcept {
    return px.x >= 1.0 && px.y >= 1.0 && px.x < end_px_.x && px.y < end_px_.y;
  }

  /// The sum at a point with a patch. Prefetches a height two rows above and two rows below the
  /// patch, which a hand moving across rows needs within a few ticks.
  [[nodiscard]] PatchSums at(Vec2 px) const noexcept {
    const auto left = static_cast<int>(px.x);
    const auto top = static_cast<int>(px.y);
    const float* corner =
        heights_ + static_cast<std::size_t>(top - 1) * stride_ + static_cast<std::size_t>(left - 1);
    prefetch_rows(corner);
    return sum_(corner, stride_, px.x - left, px.y - top);
  }

 private:
  /// The prefetched addresses may be outside the plane.
  void prefetch_rows(const float* corner) const noexcept {
    const auto address = reinterpret_cast<std::uintptr_t>(corner);
    __builtin_prefetch(reinterpret_cast<const void*>(address - 2 * stride_ * sizeof *corner));
    __builtin_prefetch(reinterpret_cast<const void*>(address + 5 * stride_ * sizeof *corner));
  }

  const float* heights_ = nullptr;
  std::size_t stride_ = 0;
  Vec2 end_px_;
  SumOfPatch sum_ = nullptr;
};

}  // namespace touchtrial::engine
