/// \file Images with samples of any type.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

namespace touchtrial {

/// A dense rectangle of samples, indexed [row y][column x], row-major, no padding.
/// A plane may be empty (0 x 0); the functions of the engine refuse an empty one.
template <typename Sample>
class Plane {
 public:
  Plane() = default;

  /// \param height,width  in samples, >= 0
  /// \param fill  the initial value of every sample
  /// \throws std::invalid_argument if a side is negative
  Plane(int height, int width, Sample fill = Sample{})
      : height_(checked(height)),
        width_(checked(width)),
        samples_(static_cast<std::size_t>(height) * static_cast<std::size_t>(width), fill) {}

  [[nodiscard]] int height() const noexcept { return height_; }
  [[nodiscard]] int width() const noexcept { return width_; }
  [[nodiscard]] std::size_t size() const noexcept { return samples_.size(); }
  [[nodiscard]] bool empty() const noexcept { return samples_.empty(); }

  /// Unchecked access; 0 <= y < height, 0 <= x < width.
  [[nodiscard]] Sample& at(int y, int x) noexcept { return samples_[index(y, x)]; }
  [[nodiscard]] const Sample& at(int y, int x) const noexcept { return samples_[index(y, x)]; }

  [[nodiscard]] std::span<Sample> row(int y) noexcept {
    return {samples_.data() + index(y, 0), static_cast<std::size_t>(width_)};
  }
  [[nodiscard]] std::span<const Sample> row(int y) const noexcept {
    return {samples_.data() + index(y, 0), static_cast<std::size_t>(width_)};
  }

  [[nodiscard]] std::span<Sample> samples() noexcept { return samples_; }
  [[nodiscard]] std::span<const Sample> samples() const noexcept { return samples_; }

  friend bool operator==(const Plane&, const Plane&) = default;

 private:
  static int checked(int extent) {
    if (extent < 0) throw std::invalid_argument("a plane's side cannot be negative");
    return extent;
  }
  [[nodiscard]] std::size_t index(int y, int x) const noexcept {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  int height_ = 0;
  int width_ = 0;
  std::vector<Sample> samples_;
};

/// An 8-bit grey image; 0 is black, 255 is white.
using GreyImage = Plane<std::uint8_t>;

/// The plane with every sample converted, for instance from grey levels to double.
template <typename To, typename From>
[[nodiscard]] Plane<To> converted(const Plane<From>& source) {
  Plane<To> result(source.height(), source.width());
  for (std::size_t i = 0; i < source.size(); ++i) {
    result.samples()[i] = static_cast<To>(source.samples()[i]);
  }
  return result;
}

/// Moves a temporary plane that already has the requested type.
template <typename Sample>
[[nodiscard]] Plane<Sample> converted(Plane<Sample>&& plane) {
  return std::move(plane);
}

/// The mean of all samples, added up in double, row by row. NaN if the plane is empty.
template <typename Sample>
[[nodiscard]] double mean_of(const Plane<Sample>& plane) {
  double sum = 0.0;
  for (const Sample sample : plane.samples()) sum += static_cast<double>(sample);
  return sum / static_cast<double>(plane.size());
}

/// Whether all samples are equal.
/// \pre the plane is not empty
template <typename Sample>
[[nodiscard]] bool is_flat(const Plane<Sample>& plane) {
  const Sample level = plane.samples().front();
  return std::ranges::all_of(plane.samples(), [level](Sample sample) { return sample == level; });
}

}  // namespace touchtrial
