/// \file Metadata of a picture file, and facts found while decoding it. Source: Exif 2.32,
/// TIFF 6.0, PNG (pHYs, eXIf), JFIF 1.02.
#pragma once

#include "core/bytes.hpp"
#include "core/plane.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::engine {

struct ImageNotes {
  /// 1 to 8 as in Exif and TIFF: 1 is upright, 3 upside down, 6 must be turned clockwise and 8
  /// anticlockwise; 2, 4, 5 and 7 are also mirrored.
  int orientation = 1;
  /// Resolution on the photographed object. Nothing if the file states none, if the two axes
  /// differ, or if the value comes from a camera or is a default (72, 96, 180, 240 or 350 dots per
  /// inch).
  std::optional<double> pixels_per_mm;
  /// Dots per inch written by a camera, if any.
  std::optional<double> camera_dpi;
  bool has_one_bit = false;  ///< per pixel: black or white

  // The members below are set by decoding.
  int pictures = 1;                ///< in the file, without reduced copies; the first is read
  double transparent_share = 0.0;  ///< of the pixels; they are composited on black
  bool lacks_end = false;          ///< the file has no end marker after the last pixel
  /// The lowest and highest value of a picture of heights, in its unit.
  std::optional<std::pair<double, double>> heights;
  bool has_user_range = false;  ///< whether the user stated a range
  double cut_share = 0.0;       ///< of samples clipped to the user's range or bit depth
};

/// Reads the metadata. Ignores damaged metadata, so that the picture stays readable.
/// \param file  all bytes of the file
/// Thread-safe.
[[nodiscard]] ImageNotes notes_of_image(ByteView file);

/// Formats a number with three significant digits.
[[nodiscard]] std::string rounded(double number);

/// Warnings to show before the picture is used. Each is a phrase that follows the file's name and
/// contains the remedy. None concerns the resolution.
[[nodiscard]] std::vector<std::string> remarks_on(const ImageNotes& notes);

/// Rotates and mirrors a picture to upright.
/// \param orientation  see ImageNotes; values other than 2 to 8 leave the picture unchanged
[[nodiscard]] GreyImage turn_upright(const GreyImage& image, int orientation);

}  // namespace touchtrial::engine
