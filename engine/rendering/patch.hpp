/// \file Sums over the four rows of four heights round a point: the inner part of both rendering
/// models' forces, on the widest registers that the processor has.
/// Every model that reads four rows of four heights can use them.
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

/// A sum over a patch. Every instruction set gives the same digits: numbers are added in one order,
/// and no product is fused with a sum. No allocation, lock or exception. Thread-safe.
/// \param corner  the first height of the first row
/// \param stride  from one row to the next, heights
/// \param u,v  the point's way from the second column to the third, and from the second row to the
///   third, 0 to 1
using SumOfPatch = PatchSums (*)(const float* corner, std::size_t stride, double u, double v);

/// The height between the four middle ones, bilinear, and likewise between their tangential forces
/// in a neighbourhood of 3 (docs/method.md, "Force field"). There a pixel's own height cancels in
/// each pair of opposite neighbours, so that the force is [1 2 1] / 2 across and [1 0 -1] along its
/// component.
/// \throws Error if Highway's library, which the first call loads, cannot be used
[[nodiscard]] SumOfPatch bilinear_sum();

/// Value and gradient of the cubic B-spline whose coefficients are the heights.
/// \throws Error as bilinear_sum
[[nodiscard]] SumOfPatch spline_sum();

/// The patches of a plane: every point but those in the outer pixels has one.
class Patches {
 public:
  /// An empty set: no point has a patch.
  Patches() = default;
  /// \param heights  row-major, height_px x width_px; must outlive this
  Patches(std::span<const float> heights, int height_px, int width_px, SumOfPatch sum) noexcept
      : heights_(heights.data()),
        stride_(static_cast<std::size_t>(width_px)),
        end_px_{width_px - 2.0, height_px - 2.0},
        sum_(sum) {}

  /// \param px  in continuous pixel coordinates; pixel centres are whole numbers
  [[nodiscard]] bool has(Vec2 px) const noexcept {
    return px.x >= 1.0 && px.y >= 1.0 && px.x < end_px_.x && px.y < end_px_.y;
  }

  /// The sum at a point that has a patch. Prefetches a height two rows above the patch and one two
  /// rows below, which a hand that moves across rows needs within a few ticks.
  [[nodiscard]] PatchSums at(Vec2 px) const noexcept {
    const auto left = static_cast<int>(px.x);
    const auto top = static_cast<int>(px.y);
    const float* corner =
        heights_ + static_cast<std::size_t>(top - 1) * stride_ + static_cast<std::size_t>(left - 1);
    fetch_beside(corner);
    return sum_(corner, stride_, px.x - left, px.y - top);
  }

 private:
  /// The heights may lie beyond the plane.
  void fetch_beside(const float* corner) const noexcept {
    const auto at = reinterpret_cast<std::uintptr_t>(corner);
    __builtin_prefetch(reinterpret_cast<const void*>(at - 2 * stride_ * sizeof *corner));
    __builtin_prefetch(reinterpret_cast<const void*>(at + 5 * stride_ * sizeof *corner));
  }

  const float* heights_ = nullptr;
  std::size_t stride_ = 0;
  Vec2 end_px_;
  SumOfPatch sum_ = nullptr;
};

}  // namespace touchtrial::engine
