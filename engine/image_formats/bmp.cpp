#include "engine/image_formats/image_format.hpp"

#include <algorithm>
#include <array>

namespace touchtrial::engine {
namespace {

constexpr std::size_t kFileHeaderSize = 14;
constexpr std::size_t kMasksOffset = 54;
constexpr std::uint32_t kInfoHeaderSize = 40;
constexpr std::uint32_t kMaxColours = 256;
constexpr std::uint32_t kHeaderSizeWithAlphaMask = 56;

enum Compression : std::uint32_t { kNone = 0, kRle8 = 1, kRle4 = 2, kBitFields = 3 };

struct BmpHeader {
  std::uint32_t size = 0;
  std::int64_t width = 0;
  std::int64_t height = 0;
  bool is_top_down = false;  ///< rows are stored from the top, not from the bottom
  std::uint32_t bits = 0;
  std::uint32_t compression = kNone;
  std::uint32_t data_size = 0;  ///< may be 0 without compression
  std::uint32_t data_offset = 0;
  std::uint32_t colours = 0;  ///< entries of the palette; 0: as many as the bits can address
};

BmpHeader read_bmp_header(ByteView file) {
  BmpHeader header;
  header.size = little32(file, kFileHeaderSize);
  if (header.size < kInfoHeaderSize)
    throw_unsupported_image("is an OS/2 BMP, which is not supported");
  static_cast<void>(bytes_at(file, kFileHeaderSize, header.size));
  header.data_offset = little32(file, 10);
  header.width = static_cast<std::int32_t>(little32(file, 18));
  const std::int64_t rows = static_cast<std::int32_t>(little32(file, 22));
  header.is_top_down = rows < 0;
  header.height = rows < 0 ? -rows : rows;
  header.bits = little16(file, 28);
  header.compression = little32(file, 30);
  header.data_size = little32(file, 34);
  header.colours = little32(file, 46);
  return header;
}

bool has_standard_masks(ByteView file) {
  return little32(file, kMasksOffset) == 0x00FF0000U &&
         little32(file, kMasksOffset + 4) == 0x0000FF00U &&
         little32(file, kMasksOffset + 8) == 0x000000FFU;
}

bool has_alpha(ByteView file, const BmpHeader& header) {
  return header.compression == kBitFields && header.size >= kHeaderSizeWithAlphaMask &&
         little32(file, kMasksOffset + 12) == 0xFF000000U;
}

bool is_supported(ByteView file, const BmpHeader& header) {
  switch (header.compression) {
    case kNone:
      return header.bits == 1 || header.bits == 4 || header.bits == 8 || header.bits == 24 ||
             header.bits == 32;
    case kRle8:
      return header.bits == 8;
    case kRle4:
      return header.bits == 4;
    case kBitFields:
      return header.bits == 32 && has_standard_masks(file);
    default:
      return false;
  }
}

bool is_run_length(const BmpHeader& header) {
  return header.compression == kRle8 || header.compression == kRle4;
}

/// Bytes of a row; rows are padded to a multiple of four.
std::uint64_t row_size(const BmpHeader& header) {
  return (static_cast<std::uint64_t>(header.width) * header.bits + 31) / 32 * 4;
}

/// The pixel data. Compressed data have the size stated in the header.
ByteView data_of(ByteView file, const BmpHeader& header) {
  const std::uint64_t size = is_run_length(header)
                                 ? header.data_size
                                 : row_size(header) * static_cast<std::uint64_t>(header.height);
  if (size == 0) throw_truncated_image();
  return bytes_at(file, header.data_offset, size);
}

/// The grey levels of the palette; missing entries are black.
using Palette = std::array<std::uint8_t, kMaxColours>;

Palette read_palette(ByteView file, const BmpHeader& header) {
  Palette palette{};
  if (header.bits > 8) return palette;
  const std::size_t count = header.colours == 0 ? std::size_t{1} << header.bits : header.colours;
  if (count > kMaxColours) throw_truncated_image();
  const ByteView entries = bytes_at(file, kFileHeaderSize + header.size, 4 * count);
  for (std::size_t i = 0; i < count; ++i) {
    palette[i] = luma(entries[4 * i + 2], entries[4 * i + 1], entries[4 * i]);
  }
  return palette;
}

/// The `index`-th number of `bits` (1, 4 or 8) bits. The first is in the highest bits.
std::size_t packed_number(ByteView bytes, std::size_t index, std::size_t bits) {
  const std::size_t per_byte = 8 / bits;
  const std::size_t shift = (per_byte - 1 - index % per_byte) * bits;
  return bytes[index / per_byte] >> shift & ((std::size_t{1} << bits) - 1);
}

void read_row(ByteView row_bytes, std::size_t bits, Alpha alpha, const Palette& palette,
              GreyScale& scale, std::span<std::uint8_t> row) {
  for (std::size_t x = 0; x < row.size(); ++x) {
    if (bits <= 8) {
      row[x] = palette[packed_number(row_bytes, x, bits)];
    } else {
      const std::uint8_t* bgr = &row_bytes[x * bits / 8];
      const std::array<std::uint8_t, 4> rgba = {bgr[2], bgr[1], bgr[0],
                                                bits == 32 ? bgr[3] : std::uint8_t{255}};
      row[x] = scale.grey_of(rgba.data(), 4, alpha);
    }
  }
}

/// Unpacks run-length codes: runs of pixels, and jumps over pixels, which get the palette's first
/// colour. Rows are contiguous.
class RunLengths {
 public:
  RunLengths(ByteView data, const BmpHeader& header, const Palette& palette)
      : data_(data),
        bits_(header.bits),
        width_(static_cast<std::size_t>(header.width)),
        palette_(palette),
        pixels_(width_ * static_cast<std::size_t>(header.height), palette[0]) {}

  Bytes read() {
    while (pixel_index_ < pixels_.size()) {
      const ByteView code = take(2);
      if (code[0] != 0) {
        repeat(code[0], code[1]);
      } else if (code[1] > 2) {
        copy(code[1]);
      } else if (code[1] == kEndOfPicture) {
        break;
      } else if (code[1] == kJump) {
        const ByteView jump = take(2);
        pixel_index_ += jump[0] + jump[1] * width_;
        row_is_full_ = false;
      } else {
        // After a full row the position is already at the start of the next row.
        if (!row_is_full_) pixel_index_ += width_ - pixel_index_ % width_;
        row_is_full_ = false;
      }
    }
    return std::move(pixels_);
  }

 private:
  enum Code : std::uint8_t { kEndOfRow = 0, kEndOfPicture = 1, kJump = 2 };

  ByteView take(std::size_t count) {
    const ByteView bytes = bytes_at(data_, 0, count);
    data_ = data_.subspan(count);
    return bytes;
  }

  void repeat(std::size_t count, std::uint8_t value) {
    const std::array<std::uint8_t, 1> packed_byte = {value};
    const std::size_t per_byte = 8 / bits_;
    put(count, [&](std::size_t i) { return packed_number(packed_byte, i % per_byte, bits_); });
  }

  void copy(std::size_t count) {
    const std::size_t size = (count * bits_ + 7) / 8;
    const ByteView numbers = take(size + size % 2);
    put(count, [&](std::size_t i) { return packed_number(numbers, i, bits_); });
  }

  template <typename PixelAt>
  void put(std::size_t count, PixelAt pixel_at) {
    if (pixel_index_ % width_ + count > width_) throw_truncated_image();
    for (std::size_t i = 0; i < count; ++i) pixels_[pixel_index_++] = palette_[pixel_at(i)];
    row_is_full_ = pixel_index_ % width_ == 0;
  }

  ByteView data_;
  std::size_t bits_;
  std::size_t width_;
  const Palette& palette_;
  Bytes pixels_;
  std::size_t pixel_index_ = 0;
  bool row_is_full_ = false;  ///< whether the last run ended at the end of a row
};

}  // namespace

GreyImage read_bmp(ByteView file, GreyScale& scale) {
  const BmpHeader header = read_bmp_header(file);
  check_image_size(header.width, header.height);
  if (!is_supported(file, header)) {
    throw_unsupported_image("is a BMP of " + std::to_string(header.bits) +
                            " bits and compression " + std::to_string(header.compression) +
                            ", which is not supported");
  }
  const ByteView data = data_of(file, header);
  const Palette palette = read_palette(file, header);
  const Alpha alpha = has_alpha(file, header) ? Alpha::straight : Alpha::none;
  const bool is_compressed = is_run_length(header);
  const Bytes unpacked_pixels = is_compressed ? RunLengths(data, header, palette).read() : Bytes();
  GreyImage image(static_cast<int>(header.height), static_cast<int>(header.width));
  const std::size_t size =
      is_compressed ? static_cast<std::size_t>(header.width) : row_size(header);
  for (int y = 0; y < image.height(); ++y) {
    const auto stored_y = static_cast<std::size_t>(header.is_top_down ? y : image.height() - 1 - y);
    const auto row = image.row(y);
    if (is_compressed) {
      std::copy_n(unpacked_pixels.begin() + static_cast<std::ptrdiff_t>(stored_y * size), size,
                  row.begin());
    } else {
      read_row(data.subspan(stored_y * size, size), header.bits, alpha, palette, scale, row);
    }
  }
  return image;
}

}  // namespace touchtrial::engine
