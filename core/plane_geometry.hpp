/// \file Conversion between pixels and millimetres.
#pragma once

#include "core/vec.hpp"

namespace touchtrial {

/// The placement of an image on the virtual plane. The centre of pixel (x, y) is at
/// ((x + 0.5) * pitch, (y + 0.5) * pitch) mm from the plane's top-left corner; y points towards the
/// participant on a horizontal plane, downwards on a vertical one.
struct PlaneGeometry {
  double pitch_mm = 0.2;  ///< millimetres per pixel, > 0
  int height_px = 0;
  int width_px = 0;

  [[nodiscard]] constexpr double width_mm() const noexcept { return width_px * pitch_mm; }
  [[nodiscard]] constexpr double height_mm() const noexcept { return height_px * pitch_mm; }

  /// Continuous pixel coordinates; pixel centres are at whole numbers.
  [[nodiscard]] constexpr Vec2 to_px(double x_mm, double y_mm) const noexcept {
    return {x_mm / pitch_mm - 0.5, y_mm / pitch_mm - 0.5};
  }
  [[nodiscard]] constexpr Vec2 to_mm(double x_px, double y_px) const noexcept {
    return {(x_px + 0.5) * pitch_mm, (y_px + 0.5) * pitch_mm};
  }
  /// Whether a point lies on the textured part of the plane, edges included.
  [[nodiscard]] constexpr bool contains(double x_mm, double y_mm) const noexcept {
    return x_mm >= 0.0 && y_mm >= 0.0 && x_mm <= width_mm() && y_mm <= height_mm();
  }

  friend constexpr bool operator==(const PlaneGeometry&, const PlaneGeometry&) = default;
};

/// A length on the image, converted from millimetres to pixels.
[[nodiscard]] constexpr double to_px(double length_mm, double pitch_mm) noexcept {
  return length_mm / pitch_mm;
}

}  // namespace touchtrial
