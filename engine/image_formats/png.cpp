#include "engine/image_formats/escape.hpp"
#include "engine/image_formats/image_format.hpp"

#include <array>
#include <bit>
#include <cstring>
#include <string_view>

#include <png.h>
#include <zlib.h>

namespace touchtrial::engine {
namespace {

constexpr std::size_t kSignatureSize = 8;
constexpr std::size_t kChunkOverhead = 12;  // length, type, checksum
constexpr std::size_t kHeaderSize = 13;
/// The largest chunk without samples; a palette has only 768 bytes.
constexpr std::size_t kMaxChunk = std::size_t{1} << 23U;
constexpr int kMaxChunks = 64;

struct Chunk {
  std::string_view type;
  ByteView data;
  ByteView bytes;  ///< including length, type and checksum
};

Chunk chunk_at(ByteView file, std::size_t offset) {
  const std::size_t length = big32(file, offset);
  const ByteView bytes = bytes_at(file, offset, length + kChunkOverhead);
  const auto* type = reinterpret_cast<const char*>(bytes.data() + 4);
  return {{type, 4}, bytes.subspan(8, length), bytes};
}

struct PngHeader {
  std::uint32_t width;
  std::uint32_t height;
  int depth;
  int colour;
};

bool is_legal(const PngHeader& header) {
  const int depth = header.depth;
  const bool is_small = depth == 1 || depth == 2 || depth == 4;
  switch (header.colour) {
    case PNG_COLOR_TYPE_GRAY:
      return is_small || depth == 8 || depth == 16;
    case PNG_COLOR_TYPE_PALETTE:
      return is_small || depth == 8;
    case PNG_COLOR_TYPE_RGB:
    case PNG_COLOR_TYPE_GRAY_ALPHA:
    case PNG_COLOR_TYPE_RGB_ALPHA:
      return depth == 8 || depth == 16;
    default:
      return false;
  }
}

PngHeader read_png_header(ByteView file) {
  const Chunk first = chunk_at(file, kSignatureSize);
  if (first.type != "IHDR" || first.data.size() != kHeaderSize) throw_truncated_image();
  const PngHeader header{big32(first.data, 0), big32(first.data, 4), first.data[8], first.data[9]};
  check_image_size(header.width, header.height);
  if (!is_legal(header)) {
    throw_unsupported_image("is a PNG of bit depth " + std::to_string(header.depth) +
                            " and colour type " + std::to_string(header.colour) +
                            ", which is not supported");
  }
  return header;
}

/// Refuses too little data before decompression: deflate compresses at most 1032 to 1.
void check_packed_size(const PngHeader& header, std::uint64_t packed_bytes) {
  constexpr std::array<std::uint64_t, 7> kChannels = {1, 0, 3, 1, 2, 0, 4};
  const std::uint64_t row_bits = kChannels.at(static_cast<std::size_t>(header.colour)) *
                                 static_cast<std::uint64_t>(header.depth) * header.width;
  const std::uint64_t unpacked_bytes = (row_bits + 7) / 8 * header.height;
  if (packed_bytes == 0 || unpacked_bytes > packed_bytes * 1032 + 1024) throw_truncated_image();
}

bool affects_pixels(std::string_view type) {
  return type == "IHDR" || type == "PLTE" || type == "tRNS" || type == "IDAT" || type == "IEND";
}

bool is_critical(std::string_view type) {
  return (type[0] & 0x20) == 0;
}

/// The file without colour profiles, gamma and text, for libpng.
Bytes pixel_chunks(ByteView file) {
  const PngHeader header = read_png_header(file);
  Bytes chunks(file.begin(), file.begin() + kSignatureSize);
  std::uint64_t packed_bytes = 0;
  for (std::size_t offset = kSignatureSize;;) {
    const Chunk chunk = chunk_at(file, offset);
    offset += chunk.bytes.size();
    if (affects_pixels(chunk.type)) {
      if (chunk.type == "IDAT") packed_bytes += chunk.data.size();
      chunks.insert(chunks.end(), chunk.bytes.begin(), chunk.bytes.end());
    } else if (is_critical(chunk.type)) {
      throw_unsupported_image("is a PNG with an unknown critical chunk");
    }
    if (chunk.type == "IEND") break;
  }
  check_packed_size(header, packed_bytes);
  return chunks;
}

[[noreturn]] void leave(png_structp png, png_const_charp what) {
  static_cast<Escape*>(png_get_error_ptr(png))->leave(what);
}

void ignore_warning(png_structp /*png*/, png_const_charp /*warning*/) {}

void read_bytes(png_structp png, png_bytep target, std::size_t count) {
  auto& remaining = *static_cast<ByteView*>(png_get_io_ptr(png));
  if (count > remaining.size()) png_error(png, "ends too early");
  std::memcpy(target, remaining.data(), count);
  remaining = remaining.subspan(count);
}

/// Decodes a file in memory with libpng to rows of 8- or 16-bit grey, grey alpha, RGB or RGBA
/// samples.
class PngDecoder {
 public:
  PngDecoder(ByteView file, GreyScale& scale) : remaining_(file), scale_(scale) {}
  ~PngDecoder() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngDecoder(const PngDecoder&) = delete;
  PngDecoder& operator=(const PngDecoder&) = delete;

  GreyImage read() {
    require(run_guarded(escape_, [&] { read_start(); }));
    return png_get_bit_depth(png_, info_) == 16 ? read_rows<png_uint_16>() : read_rows<png_byte>();
  }

 private:
  void require(bool is_complete) const {
    if (!is_complete) throw_damaged_image(escape_.message.data());
  }

  void read_start() {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &escape_, leave, ignore_warning);
    info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
    if (info_ == nullptr) escape_.leave("libpng is out of memory or has another version");
    png_set_user_limits(png_, kMaxSidePx, kMaxSidePx);
    png_set_chunk_malloc_max(png_, kMaxChunk);
    png_set_chunk_cache_max(png_, kMaxChunks);
    // The only ancillary chunk, tRNS, affects pixels as well.
    png_set_crc_action(png_, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_set_read_fn(png_, &remaining_, read_bytes);
    png_read_info(png_, info_);
    png_set_expand(png_);
    if (std::endian::native == std::endian::little) png_set_swap(png_);
    passes_ = png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
  }

  /// Reads row by row. Stores all rows only if several passes fill them.
  template <typename Sample>
  GreyImage read_rows() {
    const int height = static_cast<int>(png_get_image_height(png_, info_));
    const int channels = png_get_channels(png_, info_);
    const std::size_t row_size = png_get_rowbytes(png_, info_) / sizeof(Sample);
    GreyImage image(height, static_cast<int>(png_get_image_width(png_, info_)));
    std::vector<Sample> samples(passes_ == 1 ? row_size
                                             : row_size * static_cast<std::size_t>(height));
    const auto row_of = [&](int y) {
      return samples.data() + (passes_ == 1 ? 0 : row_size * static_cast<std::size_t>(y));
    };
    require(run_guarded(escape_, [&] {
      for (int pass = 1; pass <= passes_; ++pass) {
        for (int y = 0; y < height; ++y) {
          png_read_row(png_, reinterpret_cast<png_bytep>(row_of(y)), nullptr);
          if (pass == passes_) {
            scale_.make_grey(row_of(y), channels, Alpha::straight, image.row(y));
          }
        }
      }
      png_read_end(png_, nullptr);
    }));
    return image;
  }

  Escape escape_;
  ByteView remaining_;
  GreyScale& scale_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  int passes_ = 1;
};

void append_bytes(png_structp png, png_bytep source, std::size_t count) {
  bool fits = true;
  try {
    auto& file = *static_cast<Bytes*>(png_get_io_ptr(png));
    file.insert(file.end(), source, source + count);
  } catch (const std::exception&) {
    fits = false;
  }
  if (!fits) png_error(png, "out of memory");
}

void no_flush(png_structp /*png*/) {}

}  // namespace

std::pair<int, int> size_of_png(ByteView file) {
  const PngHeader header = read_png_header(file);
  return {static_cast<int>(header.width), static_cast<int>(header.height)};
}

GreyImage read_png(ByteView file, GreyScale& scale) {
  const Bytes chunks = pixel_chunks(file);
  return PngDecoder(chunks, scale).read();
}

Bytes png_of_samples(int height, int width, int channels, std::span<const std::uint8_t> samples) {
  Bytes file;
  Escape escape;
  png_structp png = nullptr;
  png_infop info = nullptr;
  const bool is_complete = run_guarded(escape, [&] {
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &escape, leave, ignore_warning);
    info = png == nullptr ? nullptr : png_create_info_struct(png);
    if (info == nullptr) escape.leave("libpng is out of memory or has another version");
    png_set_write_fn(png, &file, append_bytes, no_flush);
    // Textures compress poorly without filtered rows and zlib's best compression.
    png_set_compression_level(png, Z_BEST_COMPRESSION);
    png_set_compression_strategy(png, Z_FILTERED);
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
                 channels == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    const std::size_t row_size =
        static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
    for (std::size_t offset = 0; offset < samples.size(); offset += row_size) {
      png_write_row(png, samples.data() + offset);
    }
    png_write_end(png, info);
  });
  png_destroy_write_struct(&png, &info);
  if (!is_complete) throw_damaged_image(escape.message.data());
  return file;
}

}  // namespace touchtrial::engine
