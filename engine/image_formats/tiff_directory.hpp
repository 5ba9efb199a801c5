/// \file The directory of a TIFF file. Exif notes in other files are one as well.
/// Source: TIFF 6.0, section 2.
#pragma once

#include "core/bytes.hpp"
#include "engine/image_formats/image_format.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace touchtrial::engine {

enum class TiffTag : std::uint32_t {
  width = 256,
  height = 257,
  bits_per_sample = 258,
  compression = 259,
  photometric = 262,
  fill_order = 266,
  strip_offsets = 273,
  orientation = 274,
  samples_per_pixel = 277,
  rows_per_strip = 278,
  strip_byte_counts = 279,
  x_resolution = 282,
  y_resolution = 283,
  planar = 284,
  resolution_unit = 296,
  predictor = 317,
  tile_width = 322,
  tile_height = 323,
  tile_offsets = 324,
  tile_byte_counts = 325,
  extra_samples = 338,
  sample_format = 339,
};

/// The entries of a TIFF file's first directory.
class TiffDirectory {
 public:
  /// \throws ImageFault if the header or the directory is truncated, or a tag appears twice
  explicit TiffDirectory(ByteView file);

  [[nodiscard]] bool has(TiffTag tag) const { return entries_.count(tag) != 0; }
  /// All values of an entry (BYTE, SHORT or LONG); none if it is absent or of another type.
  /// \throws ImageFault if they are truncated
  [[nodiscard]] std::vector<std::uint32_t> values(TiffTag tag) const;
  /// The first value of an entry, or `otherwise`.
  [[nodiscard]] std::uint32_t value(TiffTag tag, std::uint32_t otherwise) const;
  /// The first value of a RATIONAL entry; nothing if it is absent, of another type, or if its
  /// denominator is 0.
  [[nodiscard]] std::optional<double> fraction(TiffTag tag) const;

 private:
  ByteView file_;
  ByteOrder order_;
  std::map<TiffTag, std::size_t> entries_;  ///< where the 12 bytes of each tag's entry start
};

}  // namespace touchtrial::engine
