/// \file Pictures in colour, for people to look at; the engine computes with grey ones only.
#pragma once

#include "core/bytes.hpp"
#include "core/plane.hpp"

#include <cstdint>

namespace touchtrial::engine {

struct Rgb {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;

  friend bool operator==(const Rgb&, const Rgb&) = default;
};
using ColourImage = Plane<Rgb>;

/// A whole 8-bit PNG file in memory. The same picture gives the same bytes on one machine.
/// \throws std::invalid_argument if the picture is empty
/// \throws FileError if it cannot be encoded: it is too large
[[nodiscard]] Bytes png_bytes(const GreyImage& image);
[[nodiscard]] Bytes png_bytes(const ColourImage& image);

/// A picture brought to another size: means of areas where it shrinks, bicubic where it grows.
/// Computed in double, rounded half up.
/// \param height,width  >= 1
/// \throws std::invalid_argument if the picture is empty or a side is below 1
[[nodiscard]] GreyImage resized(const GreyImage& image, int height, int width);

}  // namespace touchtrial::engine
