/// \file Reads PNG, JPEG, TIFF, BMP, GIF and PGM/PPM pictures of 8 or 16 bits, in grey or colour,
/// with or without alpha; writes PNG. Source of the conversion rules: docs/method.md, "Images".
#pragma once

#include "core/bytes.hpp"
#include "core/plane.hpp"
#include "engine/image_notes.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace touchtrial::engine {

/// Images whose header states a larger size are refused before memory is allocated.
inline constexpr std::int64_t kMaxImagePixels = std::int64_t{1} << 28;

/// A decoded picture.
struct Picture {
  GreyImage grey;
  ImageNotes notes;
};

/// A picture of 16-bit samples whose maximum is below this limit comes from a camera or scanner of
/// 8 to 14 bits, and would have few grey levels.
inline constexpr std::uint32_t kMinMaxWideSample = 1U << 14U;

/// The conversion of samples of more than 8 bits to grey levels, shared by all pictures of a set.
struct SampleScale {
  /// The number of low bits that 16-bit samples use, 9 to 16; 0: all bits.
  int bits = 0;
  /// The heights that become 0 and 255, first < second; nothing: the lowest and highest height of
  /// each picture.
  std::optional<std::pair<double, double>> heights;
};

/// Reads a picture as 8-bit grey: 16-bit samples become floor(v / 257 + 0.5), alpha is composited
/// on black, colour becomes floor((299 R + 587 G + 114 B + 500) / 1000). PGM and PPM samples of any
/// other maximum, and 16-bit samples that use fewer bits, become floor(v * 255 / maximum + 0.5).
/// Floating-point samples of a TIFF are heights h of the range [a, b], and become floor(255 (h - a)
/// / (b - a) + 0.5), from 0 to 255. If a file has several pictures, the first that is not a reduced
/// copy is read. Orientation tags (Exif, TIFF), colour profiles and gamma are ignored; samples are
/// used as stored.
/// \throws FileError if the file is missing, truncated, damaged, empty, of an unknown kind or of an
///   unsupported sample type; if it has more than kMaxImagePixels pixels or a side of more than a
///   million; if all its 16-bit samples are below kMinMaxWideSample, but not all 0, and
///   `scale.bits` is 0; if more than one sample in a thousand exceeds `scale.bits`; or if a height
///   is a gap
/// Thread-safe. A file over 64 MiB is mapped and must not be truncated meanwhile; the cost depends
/// on the picture, not on the size of the file.
[[nodiscard]] Picture read_picture(const std::filesystem::path& path,
                                   const SampleScale& scale = {});
/// Reads only the grey levels.
[[nodiscard]] GreyImage read_grey_image(const std::filesystem::path& path);

/// Whether a file has the signature of a PNG, JPEG, TIFF or GIF. The two-byte signatures of other
/// kinds are too short to be conclusive. False for an unreadable file.
[[nodiscard]] bool begins_like_image(const std::filesystem::path& path);

/// Width and height of a picture, pixels. Reads only the header of a PNG; decodes other kinds.
/// \throws as read_grey_image
[[nodiscard]] std::pair<int, int> size_of_image(const std::filesystem::path& path);

/// Decodes a picture from a file's bytes, like read_picture().
/// \param name  used as the path in messages
[[nodiscard]] Picture decode_picture(ByteView file, const std::string& name,
                                     const SampleScale& scale = {});

/// The opacity of a picture: 255 for opaque pixels, 0 for all others.
/// \throws as decode_picture
[[nodiscard]] GreyImage opacity_of(ByteView file, const std::string& name);

/// Writes an 8-bit grey PNG. The same image gives the same bytes on one machine.
/// \param image  at least 1 x 1
/// \throws as write_output
/// \throws std::invalid_argument if the image is empty
void write_png(const std::filesystem::path& path, const GreyImage& image);

}  // namespace touchtrial::engine
