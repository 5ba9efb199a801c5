/// \file Colour pictures for display, PNG encoding, and resizing. The engine computes only with
///   grey pictures.
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

/// Encodes an 8-bit PNG file. The same picture gives the same bytes on one machine.
/// \throws std::invalid_argument if the picture is empty
/// \throws FileError if the picture is too large to be encoded
[[nodiscard]] Bytes png_bytes(const GreyImage& image);
[[nodiscard]] Bytes png_bytes(const ColourImage& image);

/// Resizes a picture, by area averaging if it shrinks, else bicubically. Computes in double and
/// rounds half up.
/// \param height,width  >= 1
/// \throws std::invalid_argument if the picture is empty or a side is below 1
[[nodiscard]] GreyImage resized(const GreyImage& image, int height, int width);

}  // namespace touchtrial::engine
