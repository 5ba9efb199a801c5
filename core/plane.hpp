/// \file An owning row-major image of any sample type.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

namespace touchtrial {

/// A dense rectangle of samples, indexed [row y][column x], row-major, no padding.
/// A plane may be empty (0 x 0); the engine's functions refuse empty planes.
template <typename Sample>
class Plane {
 public:
  Plane() = default;

  /// \param height,width  samples, >= 0; every sample starts as `fill`
  /// \throws std::invalid_argument if one is negative
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

/// A plane converted sample by sample, for instance grey levels to double.
template <typename To, typename From>
[[nodiscard]] Plane<To> converted(const Plane<From>& from) {
  Plane<To> to(from.height(), from.width());
  for (std::size_t i = 0; i < from.size(); ++i) {
    to.samples()[i] = static_cast<To>(from.samples()[i]);
  }
  return to;
}

}  // namespace touchtrial
