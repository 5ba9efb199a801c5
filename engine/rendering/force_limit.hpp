/// \file The limit that every rendering model keeps. Private to engine/rendering.
#pragma once

#include "core/vec.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::engine {

/// The force, shortened to the limit with its direction kept. Also for forces whose squares
/// overflow; what is not finite becomes zero.
[[nodiscard]] inline Vec3 limited_in_norm(Vec3 force_n, double limit_n) noexcept {
  const double squares = force_n.x * force_n.x + force_n.y * force_n.y + force_n.z * force_n.z;
  if (squares <= limit_n * limit_n) return force_n;
  if (!is_finite(force_n)) return {};
  const double largest = std::max({std::abs(force_n.x), std::abs(force_n.y), std::abs(force_n.z)});
  const Vec3 direction = (1.0 / largest) * force_n;
  return (limit_n / norm(direction)) * direction;
}

}  // namespace touchtrial::engine
