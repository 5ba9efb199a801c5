/// \file Reads and writes picture files: PNG, JPEG, TIFF, BMP and PGM/PPM; 8 and 16 bit; grey,
/// colour and alpha. Source of the conversion rules: docs/method.md, "Images".
#pragma once

#include "core/bytes.hpp"
#include "core/plane.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>

namespace touchtrial::engine {

/// Larger images are refused by their header, before memory is allocated.
inline constexpr std::int64_t kMaxImagePixels = std::int64_t{1} << 28;

/// Reads a picture as 8-bit grey: 16-bit samples become floor(v / 257 + 0.5), alpha is composited
/// on black, colour becomes floor((299 R + 587 G + 114 B + 500) / 1000). PGM and PPM samples of any
/// other maximum become floor(v * 255 / maximum + 0.5). If a file has several pictures, the first
/// is read. Orientation tags (Exif, TIFF), colour profiles and gamma are ignored: the samples count
/// as they are stored.
/// \throws FileError if the file is missing, truncated, not an image of a known kind, zero-sized or
///   of an unsupported sample type, if it has more than kMaxImagePixels pixels or a side of more
///   than a million, or if the decoder finds its data damaged
/// Prints nothing, even if the decoder complains. Thread-safe. A file over 64 MiB is mapped, and
/// must not become shorter meanwhile; its cost depends on the picture, not on the size of the file.
[[nodiscard]] GreyImage read_grey_image(const std::filesystem::path& path);

/// Width and height of a picture, pixels. Takes a moment for a PNG, whose header alone is read, and
/// as long as read_grey_image for other kinds.
/// \throws as read_grey_image
[[nodiscard]] std::pair<int, int> size_of_image(const std::filesystem::path& path);

/// The same as read_grey_image from a file's bytes.
/// \param name  stands for the path in messages
[[nodiscard]] GreyImage decode_grey_image(ByteView file, const std::string& name);

/// Writes an 8-bit grey PNG. The same image gives the same bytes on one machine.
/// \param image  at least 1 x 1
/// \throws as write_output
/// \throws std::invalid_argument if the image is empty
void write_png(const std::filesystem::path& path, const GreyImage& image);

}  // namespace touchtrial::engine
