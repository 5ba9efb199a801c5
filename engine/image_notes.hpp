/// \file What a picture file says beside its pixels: which way up it is, and how large it was.
/// Source: Exif 2.32, TIFF 6.0, PNG (pHYs, eXIf), JFIF 1.02.
#pragma once

#include "core/bytes.hpp"
#include "core/plane.hpp"

#include <optional>

namespace touchtrial::engine {

struct ImageNotes {
  /// As in Exif and TIFF, 1 to 8: 1 upright, 3 upside down, 6 to be turned clockwise, 8
  /// anticlockwise, 2, 4, 5 and 7 mirrored as well.
  int orientation = 1;
  /// Nothing if the file does not say, says it differently for the two axes, or says 72 or 96 dots
  /// an inch, which cameras and programs write when they do not know.
  std::optional<double> pixels_per_mm;
};

/// Notes never decide whether a picture can be read: what is damaged in them counts as not said.
/// \param file  all its bytes
/// Thread-safe.
[[nodiscard]] ImageNotes notes_of_image(ByteView file);

/// The picture turned and mirrored so that it is upright.
/// \param orientation  see ImageNotes; anything but 2 to 8 leaves it as it is
[[nodiscard]] GreyImage upright(const GreyImage& image, int orientation);

}  // namespace touchtrial::engine
