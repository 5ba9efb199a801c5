/// \file Reads and writes picture files: PNG, JPEG, TIFF, BMP, GIF and PGM/PPM; 8 and 16 bit; grey,
/// colour and alpha. Source of the conversion rules: docs/method.md, "Images".
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

/// Larger images are refused by their header, before memory is allocated.
inline constexpr std::int64_t kMaxImagePixels = std::int64_t{1} << 28;

/// A decoded picture.
struct Picture {
  GreyImage grey;
  ImageNotes notes;
};

/// Below this maximum, 16-bit samples are from a camera or scanner of 8 to 14 bits, and few grey
/// levels would remain.
inline constexpr std::uint32_t kMinMaxWideSample = 1U << 14U;

/// The conversion of samples of more than 8 bits to grey levels, the same for all pictures of a
/// set.
struct SampleScale {
  /// 9 to 16: 16-bit samples lie in that many of their lowest bits; 0: in all of them.
  int bits = 0;
  /// The heights that become 0 and 255, the first below the second; nothing: the lowest and the
  /// highest of each picture.
  std::optional<std::pair<double, double>> heights;
};

/// Reads a picture as 8-bit grey: 16-bit samples become floor(v / 257 + 0.5), alpha is composited
/// on black, colour becomes floor((299 R + 587 G + 114 B + 500) / 1000). PGM and PPM samples of any
/// other maximum become floor(v * 255 / maximum + 0.5), and so do 16-bit samples in fewer bits. The
/// floating-point samples of a TIFF are heights h of the range [a, b], and become floor(255 (h - a)
/// / (b - a) + 0.5), from 0 to 255. If a file has several pictures, the first that is not a reduced
/// copy is read. Orientation tags (Exif, TIFF), colour profiles and gamma are ignored: the samples
/// count as they are stored.
/// \throws FileError if the file is missing, truncated, not an image of a known kind, zero-sized or
///   of an unsupported sample type, if it has more than kMaxImagePixels pixels or a side of more
///   than a million, if the decoder finds its data damaged, if its 16-bit samples are below
///   kMinMaxWideSample but not 0 and `scale.bits` is 0, or do not fit into `scale.bits` (except one
///   in a thousand), or if a height is a gap Prints nothing, even if the decoder does. Thread-safe.
///   A file over 64 MiB is mapped, and must not become shorter meanwhile; its cost depends on the
///   picture, not on the size of the file.
[[nodiscard]] Picture read_picture(const std::filesystem::path& path,
                                   const SampleScale& scale = {});
/// Its grey levels.
[[nodiscard]] GreyImage read_grey_image(const std::filesystem::path& path);

/// Whether a file begins like a PNG, JPEG, TIFF or GIF; the two-byte signatures of other kinds are
/// too short to count. False for an unreadable file.
[[nodiscard]] bool begins_like_image(const std::filesystem::path& path);

/// Width and height of a picture, pixels. Fast for a PNG, of which only the header is read; as slow
/// as read_grey_image for other kinds.
/// \throws as read_grey_image
[[nodiscard]] std::pair<int, int> size_of_image(const std::filesystem::path& path);

/// The same as read_picture from a file's bytes.
/// \param name  used as the path in messages
[[nodiscard]] Picture decode_picture(ByteView file, const std::string& name,
                                     const SampleScale& scale = {});

/// The opaque part of a picture with transparent pixels: 255 there, and 0 elsewhere.
/// \throws as decode_picture
[[nodiscard]] GreyImage opacity_of(ByteView file, const std::string& name);

/// Writes an 8-bit grey PNG. The same image gives the same bytes on one machine.
/// \param image  at least 1 x 1
/// \throws as write_output
/// \throws std::invalid_argument if the image is empty
void write_png(const std::filesystem::path& path, const GreyImage& image);

}  // namespace touchtrial::engine
