/// \file Small vectors of doubles. Variable names state the units.
#pragma once

#include <cmath>

namespace touchtrial {

struct Vec2 {
  double x = 0.0;
  double y = 0.0;

  friend constexpr Vec2 operator+(Vec2 a, Vec2 b) noexcept { return {a.x + b.x, a.y + b.y}; }
  friend constexpr Vec2 operator-(Vec2 a, Vec2 b) noexcept { return {a.x - b.x, a.y - b.y}; }
  friend constexpr Vec2 operator*(double s, Vec2 a) noexcept { return {s * a.x, s * a.y}; }
  friend constexpr bool operator==(Vec2, Vec2) noexcept = default;
};

struct Vec3 {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;

  friend constexpr Vec3 operator+(Vec3 a, Vec3 b) noexcept {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend constexpr Vec3 operator-(Vec3 a, Vec3 b) noexcept {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend constexpr Vec3 operator*(double s, Vec3 a) noexcept { return {s * a.x, s * a.y, s * a.z}; }
  friend constexpr bool operator==(Vec3, Vec3) noexcept = default;
};

/// Copies a vector component by component. Compilers tend to load two components at once, and such
/// a load stalls if the components were just stored separately (store forwarding).
[[nodiscard]] inline Vec3 copy_by_component(const Vec3& a) noexcept {
  const volatile Vec3& source = a;
  return {source.x, source.y, source.z};
}

[[nodiscard]] constexpr double dot(Vec3 a, Vec3 b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[nodiscard]] inline double norm(Vec2 a) noexcept {
  return std::hypot(a.x, a.y);
}
[[nodiscard]] inline double norm(Vec3 a) noexcept {
  return std::sqrt(dot(a, a));
}
[[nodiscard]] inline bool is_finite(Vec3 a) noexcept {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

}  // namespace touchtrial
