/// \file Pictures on disk. PNG, JPEG, TIFF, BMP and PGM/PPM, 8 and 16 bit, grey, colour, alpha.
/// Source of the conversion rules: docs/method.md, "Images".
#pragma once

#include "core/bytes.hpp"
#include "core/plane.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

namespace touchtrial::engine {

/// Larger images are refused from their header, before memory is spent.
inline constexpr std::int64_t kMaxImagePixels = std::int64_t{1} << 28;

/// Reads a picture as 8-bit grey: 16-bit samples become floor(v / 257 + 0.5), alpha is composited
/// on black, colour becomes floor((299 R + 587 G + 114 B + 500) / 1000). PGM and PPM samples of any
/// other maximum become floor(v * 255 / maximum + 0.5). Of a file with several pictures the first
/// is read. Orientation tags (Exif, TIFF), colour profiles and gamma are ignored: the samples count
/// as they are stored. \throws FileError if the file is missing, truncated, not an image of a known
/// kind, zero-sized,
///   of an unsupported sample type, has more than kMaxImagePixels pixels, a side of more than a
///   million, or data that the decoder finds damaged
/// Prints nothing, whatever the decoder thinks of the file. Thread-safe.
/// A file over 64 MiB is mapped, and must not be made shorter meanwhile; what it costs goes by its
/// picture, not by its size.
[[nodiscard]] GreyImage read_grey_image(const std::filesystem::path& path);

/// The same from a file's bytes. \param name  what errors call it, in place of the path
[[nodiscard]] GreyImage decode_grey_image(ByteView file, const std::string& name);

/// Writes an 8-bit grey PNG. The same image gives the same bytes on one machine.
/// \param image  at least 1 x 1
/// \throws FileError if the file cannot be written
/// \throws std::invalid_argument if the image is empty
void write_png(const std::filesystem::path& path, const GreyImage& image);

}  // namespace touchtrial::engine
