/// \file Distances between planes.
#pragma once

#include "core/plane.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace touchtrial {

/// The largest of scale(a, b) * |a - b| over all samples; infinite if the shapes differ or a sample
/// is not a number.
template <typename A, typename B, typename Scale>
[[nodiscard]] double largest_scaled_difference(const Plane<A>& a, const Plane<B>& b, Scale scale) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (a.height() != b.height() || a.width() != b.width()) return kInfinity;
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto left = static_cast<double>(a.samples()[i]);
    const auto right = static_cast<double>(b.samples()[i]);
    const double difference = scale(left, right) * std::abs(left - right);
    if (std::isnan(difference)) return kInfinity;
    largest = std::max(largest, difference);
  }
  return largest;
}

/// The largest |a - b|.
template <typename A, typename B>
[[nodiscard]] double largest_difference(const Plane<A>& a, const Plane<B>& b) {
  return largest_scaled_difference(a, b, [](double, double) { return 1.0; });
}

/// The largest |a - b| / max(1, |b|), the measure for the precision of doubles.
template <typename A, typename B>
[[nodiscard]] double largest_relative_difference(const Plane<A>& a, const Plane<B>& b) {
  return largest_scaled_difference(
      a, b, [](double, double right) { return 1.0 / std::max(1.0, std::abs(right)); });
}

/// The largest |sample|.
template <typename Sample>
[[nodiscard]] double largest_magnitude(const Plane<Sample>& plane) {
  return largest_difference(plane, Plane<double>(plane.height(), plane.width()));
}

/// |a - b| / |b| in the Euclidean norm.
template <typename A, typename B>
[[nodiscard]] double distance_relative_to(const Plane<A>& a, const Plane<B>& b) {
  double squared = 0.0;
  double reference = 0.0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    const auto right = static_cast<double>(b.samples()[i]);
    const double difference = static_cast<double>(a.samples()[i]) - right;
    squared += difference * difference;
    reference += right * right;
  }
  return std::sqrt(squared / reference);
}

}  // namespace touchtrial
