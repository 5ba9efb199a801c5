#include "engine/image_formats/byte_order.hpp"
#include "engine/image_formats/decoder_input.hpp"
#include "engine/image_formats/tiff_directory.hpp"

#include <algorithm>
#include <set>

namespace touchtrial::engine {
namespace {

enum Compression : std::uint32_t { kNone = 1, kJpeg = 7, kFirstFax = 2, kLastFax = 4 };
enum Photometric : std::uint32_t {
  kWhiteIsZero = 0,
  kBlackIsZero = 1,
  kRgb = 2,
  kPalette = 3,
  kYcbcr = 6
};
constexpr std::uint32_t kSeparatePlanes = 2;
constexpr std::uint32_t kUnsignedSamples = 1;
constexpr std::uint32_t kStraightAlpha = 2;

struct Layout {
  std::uint32_t width;
  std::uint32_t height;
  std::uint32_t bits;
  std::uint32_t channels;
  std::uint32_t compression;
  std::uint32_t photometric;
  std::uint32_t predictor;
  bool separate;

  [[nodiscard]] bool is_grey() const { return photometric <= kBlackIsZero; }
};

/// Every channel has the value of the first one, or the entry is absent.
bool is_uniform(const TiffDirectory& directory, TiffTag tag, std::uint32_t otherwise) {
  const std::vector<std::uint32_t> all = directory.values(tag);
  const std::uint32_t first = directory.value(tag, otherwise);
  return std::all_of(all.begin(), all.end(), [&](std::uint32_t v) { return v == first; });
}

Layout read_layout(const TiffDirectory& directory) {
  const auto get = [&](TiffTag tag, std::uint32_t otherwise) {
    return directory.value(tag, otherwise);
  };
  const Layout layout{
      get(TiffTag::width, 0),
      get(TiffTag::height, 0),
      get(TiffTag::bits_per_sample, 1),
      get(TiffTag::samples_per_pixel, 1),
      get(TiffTag::compression, kNone),
      get(TiffTag::photometric, kBlackIsZero),
      get(TiffTag::predictor, 1),
      get(TiffTag::planar, 1) == kSeparatePlanes && get(TiffTag::samples_per_pixel, 1) > 1};
  check_image_size(layout.width, layout.height);
  return layout;
}

bool channels_fit(const Layout& layout) {
  switch (layout.photometric) {
    case kWhiteIsZero:
    case kBlackIsZero:
      return layout.channels == 1 ||
             (layout.channels == 2 && layout.bits >= 8 && !layout.separate &&
              layout.predictor == 1 && layout.compression != kJpeg);
    case kRgb:
      return (layout.channels == 3 || layout.channels == 4) && layout.bits >= 8;
    case kPalette:
      return layout.channels == 1 && layout.bits <= 8;
    case kYcbcr:
      return layout.channels == 3 && layout.bits == 8;
    default:
      return false;
  }
}

bool compression_fits(const Layout& layout) {
  static const std::set<std::uint32_t> kBytewise = {kNone, 5, 8, 32773, 32946};
  if (kBytewise.count(layout.compression) != 0) return true;
  if (layout.compression == kJpeg) return layout.bits == 8;
  return layout.compression >= kFirstFax && layout.compression <= kLastFax && layout.bits == 1;
}

void check_samples(const TiffDirectory& directory, const Layout& layout) {
  const std::uint32_t format = directory.value(TiffTag::sample_format, kUnsignedSamples);
  if (format != kUnsignedSamples || !is_uniform(directory, TiffTag::sample_format, format) ||
      (layout.bits != 1 && layout.bits != 8 && layout.bits != 16) ||
      !is_uniform(directory, TiffTag::bits_per_sample, 1)) {
    throw_unsupported_image("is a TIFF of " + std::to_string(layout.bits) + "-bit " +
                            (format == kUnsignedSamples ? "" : "signed or floating-point ") +
                            "samples, which is not supported");
  }
  if (!channels_fit(layout) || (layout.separate && layout.bits != 8)) {
    throw_unsupported_image("is a TIFF with an arrangement of channels (" +
                            std::to_string(layout.channels) + ", photometric " +
                            std::to_string(layout.photometric) + ") that is not supported");
  }
  if (!compression_fits(layout)) {
    throw_unsupported_image("is a TIFF of compression " + std::to_string(layout.compression) +
                            ", which is not supported");
  }
}

/// The pieces that the picture is stored in: strips are as wide as the picture.
struct Pieces {
  std::uint64_t width = 0;
  std::uint64_t height = 0;
  bool tiled = false;
  std::vector<std::uint32_t> offsets;
  std::vector<std::uint32_t> sizes;
};

Pieces read_pieces(const TiffDirectory& directory, const Layout& layout) {
  constexpr std::uint64_t kMaxTilePixels = std::uint64_t{1} << 26U;
  Pieces pieces;
  pieces.tiled = directory.has(TiffTag::tile_width);
  if (pieces.tiled) {
    pieces.width = directory.value(TiffTag::tile_width, 0);
    pieces.height = directory.value(TiffTag::tile_height, 0);
    pieces.offsets = directory.values(TiffTag::tile_offsets);
    pieces.sizes = directory.values(TiffTag::tile_byte_counts);
    if (pieces.width * pieces.height > kMaxTilePixels) throw_truncated_image();
  } else {
    pieces.width = layout.width;
    pieces.height =
        std::min(directory.value(TiffTag::rows_per_strip, layout.height), layout.height);
    pieces.offsets = directory.values(TiffTag::strip_offsets);
    pieces.sizes = directory.values(TiffTag::strip_byte_counts);
  }
  if (pieces.width == 0 || pieces.height == 0) throw_truncated_image();
  return pieces;
}

std::uint64_t ceil_divide(std::uint64_t a, std::uint64_t b) {
  return (a + b - 1) / b;
}

/// Bytes of one piece, unpacked; the last strip may be shorter than the others.
std::uint64_t unpacked_size(const Layout& layout, const Pieces& pieces, std::uint64_t row_index) {
  const std::uint64_t rows_left = layout.height - row_index * pieces.height;
  const std::uint64_t rows = pieces.tiled ? pieces.height : std::min(pieces.height, rows_left);
  const std::uint64_t channels = layout.separate ? 1 : layout.channels;
  return ceil_divide(pieces.width * channels * layout.bits, 8) * rows;
}

/// How many bytes one byte of a file may unpack to, generously; 0 if there is no limit.
std::uint64_t packing_limit(const Layout& layout) {
  if (layout.photometric == kYcbcr || layout.compression == kJpeg) return 0;
  if (layout.compression == kNone) return 1;
  return layout.bits == 1 ? 0 : 4096;
}

void check_pieces(ByteView file, const Layout& layout, const Pieces& pieces) {
  const std::uint64_t rows = ceil_divide(layout.height, pieces.height);
  const std::uint64_t columns = ceil_divide(layout.width, pieces.width);
  const std::uint64_t count = rows * columns * (layout.separate ? layout.channels : 1);
  if (pieces.offsets.size() < count || pieces.sizes.size() < count) throw_truncated_image();
  const std::uint64_t limit = packing_limit(layout);
  for (std::size_t i = 0; i < count; ++i) {
    const ByteView piece = bytes_at(file, pieces.offsets[i], pieces.sizes[i]);
    const std::uint64_t needed = unpacked_size(layout, pieces, i / columns % rows);
    if (piece.empty() || (limit != 0 && needed > limit * piece.size())) throw_truncated_image();
  }
}

/// The decoder drops alpha beside grey; told that there are twice as many grey columns, it keeps
/// it.
void describe_alpha_as_columns(const TiffDirectory& directory, const Layout& layout,
                               DecoderInput& input) {
  directory.set(input.bytes, TiffTag::width, 2 * layout.width);
  directory.set(input.bytes, TiffTag::tile_width, 2 * directory.value(TiffTag::tile_width, 0));
  directory.set(input.bytes, TiffTag::samples_per_pixel, 1);
  directory.set(input.bytes, TiffTag::bits_per_sample, layout.bits);
  directory.set(input.bytes, TiffTag::sample_format, kUnsignedSamples);
  directory.hide(input.bytes, TiffTag::extra_samples);
  input.alpha_as_columns = true;
}

/// A fourth channel that the file says nothing about is alpha by common usage.
Alpha alpha_rule(const TiffDirectory& directory, const Layout& layout) {
  if (!directory.has(TiffTag::extra_samples)) return Alpha::straight;
  const bool is_straight = directory.value(TiffTag::extra_samples, 0) == kStraightAlpha;
  // The decoder multiplies 8-bit colours by their alpha itself, with the rounding that is ours too.
  const bool is_multiplied = layout.bits == 8 && !layout.is_grey();
  return is_straight && !is_multiplied ? Alpha::straight : Alpha::ignored;
}

/// The decoder stumbles over uncompressed tiles with less than the four bytes a pixel that it makes
/// of them.
void refuse_plain_tiles(const Layout& layout, const Pieces& pieces) {
  if (!pieces.tiled || layout.compression != kNone) return;
  if (layout.bits == 16 || layout.bits * layout.channels == 32) return;
  throw_unsupported_image("is a TIFF in tiles without compression, which is not supported");
}

}  // namespace

DecoderInput check_tiff(ByteView file) {
  const TiffDirectory directory(file);
  const Layout layout = read_layout(directory);
  check_samples(directory, layout);
  const Pieces pieces = read_pieces(directory, layout);
  check_pieces(file, layout, pieces);
  refuse_plain_tiles(layout, pieces);
  DecoderInput input;
  input.bytes.assign(file.begin(), file.end());
  input.width_px = static_cast<int>(layout.width);
  input.height_px = static_cast<int>(layout.height);
  input.alpha = alpha_rule(directory, layout);
  input.white_is_zero = layout.photometric == kWhiteIsZero;
  directory.set(input.bytes, TiffTag::orientation, 1);
  if (layout.is_grey()) directory.set(input.bytes, TiffTag::photometric, kBlackIsZero);
  if (layout.channels == 2) describe_alpha_as_columns(directory, layout, input);
  return input;
}

}  // namespace touchtrial::engine
