/// \file The directory of a TIFF file; Exif metadata in other files have the same format.
/// Source: TIFF 6.0, section 2.
#pragma once

#include "core/bytes.hpp"
#include "engine/image_formats/image_format.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::engine {

enum class TiffTag : std::uint32_t {
  new_subfile_type = 254,
  subfile_type = 255,
  width = 256,
  height = 257,
  bits_per_sample = 258,
  compression = 259,
  photometric = 262,
  fill_order = 266,
  make = 271,
  model = 272,
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
  exposure_time = 33434,
  f_number = 33437,
  exif_directory = 34665,
  sensitivity = 34855,
  time_of_exposure = 36867,
  focal_length = 37386,
  lens_model = 42036,
  gdal_no_data = 42113,
};

/// The entries of one directory of a TIFF file.
class TiffDirectory {
 public:
  /// \param offset  in the file; 0: the first directory
  /// \throws ImageFault if the header or the directory is truncated, or a tag appears twice
  explicit TiffDirectory(ByteView file, std::size_t offset = 0);

  [[nodiscard]] bool has(TiffTag tag) const { return entries_.count(tag) != 0; }
  /// All values of an entry (BYTE, SHORT or LONG); none if it is absent or of another type.
  /// \throws ImageFault if they are truncated
  [[nodiscard]] std::vector<std::uint32_t> values(TiffTag tag) const;
  /// The characters of an ASCII entry without NUL and blanks; empty if it is absent.
  /// \throws ImageFault if they are truncated
  [[nodiscard]] std::string text(TiffTag tag) const;
  /// The first value of an entry, or `default_value`.
  [[nodiscard]] std::uint32_t value(TiffTag tag, std::uint32_t default_value) const;
  /// The first value of a RATIONAL entry; nothing if it is absent, of another type, or if its
  /// denominator is 0.
  [[nodiscard]] std::optional<double> fraction(TiffTag tag) const;

  [[nodiscard]] std::size_t start() const noexcept { return start_; }
  /// Offset of the next directory; 0 after the last.
  [[nodiscard]] std::size_t next() const noexcept { return next_; }
  /// Whether the directory's picture is a reduced copy of another one, such as a thumbnail.
  [[nodiscard]] bool is_reduced() const;

 private:
  /// The values of an entry, each of `size` bytes.
  [[nodiscard]] ByteView data(std::size_t entry_offset, std::size_t size) const;

  ByteView file_;
  ByteOrder order_;
  std::size_t start_ = 0;
  std::size_t next_ = 0;
  std::map<TiffTag, std::size_t> entries_;  ///< offset of each tag's 12-byte entry
};

/// The pictures of a TIFF file.
struct TiffPictures {
  std::size_t first = 0;  ///< offset of the first picture's directory
  int count = 1;
};

/// Finds the pictures, without reduced copies unless there are no others. Stops at a damaged
/// directory after the first.
/// \throws ImageFault if the header or the first directory is damaged
[[nodiscard]] TiffPictures pictures_of_tiff(ByteView file);

}  // namespace touchtrial::engine
