#include "engine/image_formats/byte_order.hpp"
#include "engine/image_formats/decoder_input.hpp"

namespace touchtrial::engine {
namespace {

constexpr std::size_t kFileHeaderSize = 14;
constexpr std::size_t kCompressionAt = 30;
constexpr std::size_t kMasksAt = 54;
constexpr std::uint32_t kInfoHeaderSize = 40;
constexpr std::uint32_t kHeaderSizeWithAlphaMask = 56;

enum Compression : std::uint32_t { kNone = 0, kRle8 = 1, kRle4 = 2, kBitFields = 3 };

struct Header {
  std::uint32_t size = 0;
  std::int64_t width = 0;
  std::int64_t height = 0;  ///< absolute; rows may be stored from the top or the bottom
  std::uint32_t bits = 0;
  std::uint32_t compression = kNone;
  std::uint32_t data_size = 0;  ///< may be 0 without compression
  std::uint32_t data_at = 0;
};

Header read_header(ByteView file) {
  Header header;
  header.size = little32(file, kFileHeaderSize);
  if (header.size < kInfoHeaderSize)
    throw_unsupported_image("is an OS/2 BMP, which is not supported");
  header.data_at = little32(file, 10);
  header.width = static_cast<std::int32_t>(little32(file, 18));
  const std::int64_t rows = static_cast<std::int32_t>(little32(file, 22));
  header.height = rows < 0 ? -rows : rows;
  header.bits = little16(file, 28);
  header.compression = little32(file, kCompressionAt);
  header.data_size = little32(file, 34);
  return header;
}

bool has_usual_masks(ByteView file) {
  return little32(file, kMasksAt) == 0x00FF0000U && little32(file, kMasksAt + 4) == 0x0000FF00U &&
         little32(file, kMasksAt + 8) == 0x000000FFU;
}

bool has_alpha(ByteView file, const Header& header) {
  return header.compression == kBitFields && header.size >= kHeaderSizeWithAlphaMask &&
         little32(file, kMasksAt + 12) == 0xFF000000U;
}

bool is_supported(ByteView file, const Header& header) {
  switch (header.compression) {
    case kNone:
      return header.bits == 1 || header.bits == 4 || header.bits == 8 || header.bits == 24 ||
             header.bits == 32;
    case kRle8:
      return header.bits == 8;
    case kRle4:
      return header.bits == 4;
    case kBitFields:
      return header.bits == 32 && has_usual_masks(file);
    default:
      return false;
  }
}

/// Bytes that the pixels take; for the compressed kinds what the header claims.
std::uint64_t data_size(const Header& header) {
  if (header.compression == kRle8 || header.compression == kRle4) return header.data_size;
  const std::uint64_t row_bits = static_cast<std::uint64_t>(header.width) * header.bits;
  return (row_bits + 31) / 32 * 4 * static_cast<std::uint64_t>(header.height);
}

}  // namespace

DecoderInput check_bmp(ByteView file) {
  const Header header = read_header(file);
  check_image_size(header.width, header.height);
  if (!is_supported(file, header)) {
    throw_unsupported_image("is a BMP of " + std::to_string(header.bits) +
                            " bits and compression " + std::to_string(header.compression) +
                            ", which is not supported");
  }
  if (bytes_at(file, header.data_at, data_size(header)).empty()) throw_truncated_image();
  DecoderInput input;
  const ByteView used = file.first(header.data_at + data_size(header));
  input.bytes.assign(used.begin(), used.end());
  input.width_px = static_cast<int>(header.width);
  input.height_px = static_cast<int>(header.height);
  // Usual masks without alpha mean the same as no masks, where the decoder knows that the fourth
  // byte is nothing.
  if (header.compression == kBitFields && !has_alpha(file, header)) {
    input.bytes[kCompressionAt] = kNone;
  }
  return input;
}

}  // namespace touchtrial::engine
