/// \file A picture file's metadata, and findings of its readers besides grey levels. Source: Exif
/// 2.32, TIFF 6.0, PNG (pHYs, eXIf), JFIF 1.02.
#pragma once

#include "core/bytes.hpp"
#include "core/plane.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::engine {

struct ImageNotes {
  /// 1 to 8 as in Exif and TIFF: 1 is upright, 3 upside down, 6 has to be turned clockwise, 8
  /// anticlockwise; 2, 4, 5 and 7 are mirrored as well.
  int orientation = 1;
  /// Of the photographed object. Nothing if the file states no resolution, different ones for the
  /// two axes, or 72 or 96 dots per inch, which are defaults for an unknown resolution; also
  /// nothing for a camera's picture, or for 180, 240 or 350.
  std::optional<double> pixels_per_mm;
  /// The dots per inch that a camera wrote; nothing if it is not from a camera, or it wrote none.
  std::optional<double> camera_dpi;
  bool has_one_bit = false;  ///< a pixel: black or white, with no grey between

  // The members below are set only when the picture is decoded.
  int pictures = 1;                ///< in the file, without reduced copies; the first one is read
  double transparent_share = 0.0;  ///< of the pixels; they are composited on black
  bool lacks_end = false;          ///< no end marker follows the last pixel
  /// The lowest and the highest of a picture of heights, in its own unit.
  std::optional<std::pair<double, double>> heights;
  bool has_given_heights = false;  ///< whether the range was given
  double cut_share = 0.0;          ///< of the samples that lie outside the range or bits given
};

/// Reads the metadata. Damaged metadata counts as absent, so that the picture stays readable.
/// \param file  all bytes of the file
/// Thread-safe.
[[nodiscard]] ImageNotes notes_of_image(ByteView file);

/// A number with three digits, which are enough for advice.
[[nodiscard]] std::string rounded(double number);

/// Remarks to read before using the picture, each the rest of a sentence that starts with the
/// file's name, with the remedy. Not about its resolution.
[[nodiscard]] std::vector<std::string> remarks_on(const ImageNotes& notes);

/// Turns and mirrors a picture so that it is upright.
/// \param orientation  see ImageNotes; any number but 2 to 8 returns the picture unchanged
[[nodiscard]] GreyImage upright(const GreyImage& image, int orientation);

}  // namespace touchtrial::engine
