#include "engine/image_formats/byte_order.hpp"
#include "engine/image_formats/decoder_input.hpp"

#include <array>
#include <string_view>

namespace touchtrial::engine {
namespace {

constexpr std::size_t kSignatureSize = 8;
constexpr std::size_t kChunkOverhead = 12;  // length, type, checksum
constexpr std::size_t kHeaderSize = 13;

enum ColourType : std::uint8_t { kGrey = 0, kRgb = 2, kPalette = 3, kGreyAlpha = 4, kRgba = 6 };

struct Chunk {
  std::string_view type;
  ByteView data;
  ByteView whole;  ///< with length, type and checksum
};

Chunk chunk_at(ByteView file, std::size_t at) {
  const std::size_t length = big32(file, at);
  const ByteView whole = bytes_at(file, at, length + kChunkOverhead);
  const auto* type = reinterpret_cast<const char*>(whole.data() + 4);
  return {{type, 4}, whole.subspan(8, length), whole};
}

struct Header {
  std::uint32_t width;
  std::uint32_t height;
  int depth;
  int colour;
};

bool is_legal(const Header& header) {
  switch (header.colour) {
    case kGrey:
      return header.depth == 1 || header.depth == 2 || header.depth == 4 || header.depth == 8 ||
             header.depth == 16;
    case kPalette:
      return header.depth == 1 || header.depth == 2 || header.depth == 4 || header.depth == 8;
    case kRgb:
    case kGreyAlpha:
    case kRgba:
      return header.depth == 8 || header.depth == 16;
    default:
      return false;
  }
}

Header read_header(ByteView file) {
  const Chunk first = chunk_at(file, kSignatureSize);
  if (first.type != "IHDR" || first.data.size() != kHeaderSize) throw_truncated_image();
  const Header header{big32(first.data, 0), big32(first.data, 4), first.data[8], first.data[9]};
  check_image_size(header.width, header.height);
  if (!is_legal(header)) {
    throw_unsupported_image("is a PNG of bit depth " + std::to_string(header.depth) +
                            " and colour type " + std::to_string(header.colour) +
                            ", which is not supported");
  }
  return header;
}

/// Deflate never packs better than 1032 to 1, so too little data shows before it is unpacked.
void check_amount(const Header& header, std::uint64_t packed_bytes) {
  constexpr std::array<std::uint64_t, 7> kChannels = {1, 0, 3, 1, 2, 0, 4};
  const std::uint64_t row_bits = kChannels.at(static_cast<std::size_t>(header.colour)) *
                                 static_cast<std::uint64_t>(header.depth) * header.width;
  const std::uint64_t unpacked_bytes = (row_bits + 7) / 8 * header.height;
  if (packed_bytes == 0 || unpacked_bytes > packed_bytes * 1032 + 1024) throw_truncated_image();
}

/// The grey level that tRNS names, as the decoder will scale it.
int transparent_sample(const Header& header, ByteView data) {
  const int sample = static_cast<int>(big16(data, 0));
  if (header.depth >= 8) return sample;
  const int maximum = (1 << header.depth) - 1;
  return (sample & maximum) * (255 / maximum);
}

bool decides_pixels(std::string_view type) {
  return type == "IHDR" || type == "PLTE" || type == "tRNS" || type == "IDAT" || type == "IEND";
}

bool is_critical(std::string_view type) {
  return (type[0] & 0x20) == 0;
}

DecoderInput started(ByteView file, const Header& header) {
  DecoderInput input;
  input.width_px = static_cast<int>(header.width);
  input.height_px = static_cast<int>(header.height);
  input.bytes.assign(file.begin(), file.begin() + kSignatureSize);
  return input;
}

}  // namespace

DecoderInput check_png(ByteView file) {
  const Header header = read_header(file);
  DecoderInput input = started(file, header);
  std::uint64_t packed_bytes = 0;
  for (std::size_t at = kSignatureSize;;) {
    const Chunk chunk = chunk_at(file, at);
    at += chunk.whole.size();
    if (!decides_pixels(chunk.type)) {
      if (is_critical(chunk.type))
        throw_unsupported_image("is a PNG with an unknown critical chunk");
      continue;
    }
    if (chunk.type == "tRNS" && header.colour == kGrey) {
      // Decoders differ in what they make of it, so it is kept from them.
      input.transparent_grey = transparent_sample(header, chunk.data);
      continue;
    }
    if (chunk.type == "IDAT") packed_bytes += chunk.data.size();
    input.bytes.insert(input.bytes.end(), chunk.whole.begin(), chunk.whole.end());
    if (chunk.type == "IEND") break;
  }
  check_amount(header, packed_bytes);
  return input;
}

}  // namespace touchtrial::engine
