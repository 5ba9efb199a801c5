/// \file The metadata of a picture file: its orientation and its resolution.
/// Source: Exif 2.32, TIFF 6.0, PNG (pHYs, eXIf), JFIF 1.02.
#pragma once

#include "core/bytes.hpp"
#include "core/plane.hpp"

#include <optional>

namespace touchtrial::engine {

struct ImageNotes {
  /// 1 to 8 as in Exif and TIFF: 1 is upright, 3 upside down, 6 has to be turned clockwise, 8
  /// anticlockwise; 2, 4, 5 and 7 are mirrored as well.
  int orientation = 1;
  /// Nothing if the file states no resolution, different ones for the two axes, or 72 or 96 dots
  /// per inch, which cameras and programs write when they do not know it.
  std::optional<double> pixels_per_mm;
};

/// Reads the metadata. Damaged metadata counts as absent, so that the picture stays readable.
/// \param file  all bytes of the file
/// Thread-safe.
[[nodiscard]] ImageNotes notes_of_image(ByteView file);

/// Turns and mirrors a picture so that it is upright.
/// \param orientation  see ImageNotes; any number but 2 to 8 returns the picture unchanged
[[nodiscard]] GreyImage upright(const GreyImage& image, int orientation);

}  // namespace touchtrial::engine
