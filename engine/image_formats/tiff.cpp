#include "core/text.hpp"
#include "engine/image_file.hpp"
#include "engine/image_formats/image_format.hpp"
#include "engine/image_formats/tiff_directory.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <string_view>

#include <tiffio.h>

namespace touchtrial::engine {
namespace {

/// The storage of a picture's samples.
struct Layout {
  std::uint32_t width;
  std::uint32_t height;
  std::uint32_t bits;
  std::uint32_t channels;
  std::uint32_t compression;
  std::uint32_t photometric;
  bool is_planar;
  bool has_heights;  ///< floating-point samples
};

/// Whether every channel has the value of the first one, or the entry is absent.
bool is_uniform(const TiffDirectory& directory, TiffTag tag, std::uint32_t default_value) {
  const std::vector<std::uint32_t> values = directory.values(tag);
  const std::uint32_t first = directory.value(tag, default_value);
  return std::all_of(values.begin(), values.end(), [&](std::uint32_t v) { return v == first; });
}

Layout read_layout(const TiffDirectory& directory) {
  const auto get = [&](TiffTag tag, std::uint32_t default_value) {
    return directory.value(tag, default_value);
  };
  const Layout layout{
      get(TiffTag::width, 0),
      get(TiffTag::height, 0),
      get(TiffTag::bits_per_sample, 1),
      get(TiffTag::samples_per_pixel, 1),
      get(TiffTag::compression, COMPRESSION_NONE),
      get(TiffTag::photometric, PHOTOMETRIC_MINISBLACK),
      get(TiffTag::planar, 1) == PLANARCONFIG_SEPARATE && get(TiffTag::samples_per_pixel, 1) > 1,
      get(TiffTag::sample_format, SAMPLEFORMAT_UINT) == SAMPLEFORMAT_IEEEFP};
  check_image_size(layout.width, layout.height);
  return layout;
}

bool has_supported_channels(const Layout& layout) {
  switch (layout.photometric) {
    case PHOTOMETRIC_MINISWHITE:
    case PHOTOMETRIC_MINISBLACK:
      return layout.channels == 1 || (layout.channels == 2 && layout.bits >= 8 &&
                                      !layout.is_planar && layout.compression != COMPRESSION_JPEG);
    case PHOTOMETRIC_RGB:
      return (layout.channels == 3 || layout.channels == 4) && layout.bits >= 8;
    case PHOTOMETRIC_PALETTE:
      return layout.channels == 1 && layout.bits <= 8;
    case PHOTOMETRIC_YCBCR:
      return layout.channels == 3 && layout.bits == 8;
    default:
      return false;
  }
}

bool has_supported_compression(const Layout& layout) {
  switch (layout.compression) {
    case COMPRESSION_NONE:
    case COMPRESSION_LZW:
    case COMPRESSION_ADOBE_DEFLATE:
    case COMPRESSION_DEFLATE:
    case COMPRESSION_PACKBITS:
      return true;
    case COMPRESSION_JPEG:
      return layout.bits == 8;
    case COMPRESSION_CCITTRLE:
    case COMPRESSION_CCITTFAX3:
    case COMPRESSION_CCITTFAX4:
      return layout.bits == 1;
    default:
      return false;
  }
}

void check_samples(const TiffDirectory& directory, const Layout& layout) {
  const std::uint32_t format = directory.value(TiffTag::sample_format, SAMPLEFORMAT_UINT);
  const bool is_supported = layout.has_heights
                                ? (layout.bits == 32 || layout.bits == 64) && layout.channels == 1
                                : format == SAMPLEFORMAT_UINT &&
                                      (layout.bits == 1 || layout.bits == 8 || layout.bits == 16);
  if (!is_supported || !is_uniform(directory, TiffTag::sample_format, format) ||
      !is_uniform(directory, TiffTag::bits_per_sample, 1)) {
    throw_unsupported_image("is a TIFF of " + std::to_string(layout.channels) + " x " +
                            std::to_string(layout.bits) + "-bit " +
                            (layout.has_heights            ? "floating-point "
                             : format == SAMPLEFORMAT_UINT ? ""
                                                           : "signed ") +
                            "samples, which is not supported");
  }
  if (!directory.has(TiffTag::photometric)) {
    throw_unsupported_image("is a TIFF without a photometric interpretation");
  }
  if (!has_supported_channels(layout) || (layout.is_planar && layout.bits != 8)) {
    throw_unsupported_image("is a TIFF with an arrangement of channels (" +
                            std::to_string(layout.channels) + ", photometric " +
                            std::to_string(layout.photometric) + ") that is not supported");
  }
  if (!has_supported_compression(layout)) {
    throw_unsupported_image("is a TIFF of compression " + std::to_string(layout.compression) +
                            ", which is not supported");
  }
}

/// The strips or tiles of a picture. A strip has the full width.
struct Pieces {
  std::uint64_t width = 0;
  std::uint64_t height = 0;
  std::uint64_t count = 0;
  bool is_tiled = false;
  std::vector<std::uint32_t> offsets;
  std::vector<std::uint32_t> sizes;
};

std::uint64_t ceil_divide(std::uint64_t a, std::uint64_t b) {
  return (a + b - 1) / b;
}

Pieces read_pieces(const TiffDirectory& directory, const Layout& layout) {
  constexpr std::uint64_t kMaxTilePixels = std::uint64_t{1} << 26U;
  Pieces pieces;
  pieces.is_tiled = directory.has(TiffTag::tile_width);
  if (pieces.is_tiled) {
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
  pieces.count = ceil_divide(layout.height, pieces.height) *
                 ceil_divide(layout.width, pieces.width) * (layout.is_planar ? layout.channels : 1);
  return pieces;
}

/// The unpacked size of one piece in bytes. The last strip may be shorter than the others.
std::uint64_t unpacked_size(const Layout& layout, const Pieces& pieces, std::uint64_t row_index) {
  const std::uint64_t remaining_rows = layout.height - row_index * pieces.height;
  const std::uint64_t rows =
      pieces.is_tiled ? pieces.height : std::min(pieces.height, remaining_rows);
  const std::uint64_t channels = layout.is_planar ? 1 : layout.channels;
  return ceil_divide(pieces.width * channels * layout.bits, 8) * rows;
}

/// An upper bound of the unpacked bytes per stored byte; 0: no bound.
std::uint64_t max_expansion(const Layout& layout) {
  if (layout.photometric == PHOTOMETRIC_YCBCR || layout.compression == COMPRESSION_JPEG) return 0;
  if (layout.compression == COMPRESSION_NONE) return 1;
  return layout.bits == 1 ? 0 : 4096;
}

void check_pieces(ByteView file, const Layout& layout, const Pieces& pieces) {
  const std::uint64_t rows = ceil_divide(layout.height, pieces.height);
  const std::uint64_t columns = ceil_divide(layout.width, pieces.width);
  if (pieces.offsets.size() < pieces.count || pieces.sizes.size() < pieces.count) {
    throw_truncated_image();
  }
  const std::uint64_t limit = max_expansion(layout);
  for (std::size_t i = 0; i < pieces.count; ++i) {
    const ByteView piece = bytes_at(file, pieces.offsets[i], pieces.sizes[i]);
    const std::uint64_t min_size = unpacked_size(layout, pieces, i / columns % rows);
    if (piece.empty() || (limit != 0 && min_size > limit * piece.size())) throw_truncated_image();
  }
}

/// A fourth channel that the file does not describe is alpha by common usage.
Alpha alpha_of(const TiffDirectory& directory) {
  switch (directory.value(TiffTag::extra_samples, EXTRASAMPLE_UNASSALPHA)) {
    case EXTRASAMPLE_UNASSALPHA:
      return Alpha::straight;
    case EXTRASAMPLE_ASSOCALPHA:
      return Alpha::multiplied;
    default:
      return Alpha::none;
  }
}

/// libtiff ignores invalid entries and assumes defaults. For entries that describe the samples,
/// this must be an error.
/// \throws ImageFault if libtiff and the directory differ
void require_agreement(TIFF* tiff, const TiffDirectory& directory, const Layout& layout) {
  const bool supports_predictor = layout.compression == COMPRESSION_LZW ||
                                  layout.compression == COMPRESSION_DEFLATE ||
                                  layout.compression == COMPRESSION_ADOBE_DEFLATE;
  for (const TiffTag tag :
       {TiffTag::bits_per_sample, TiffTag::compression, TiffTag::photometric, TiffTag::fill_order,
        TiffTag::samples_per_pixel, TiffTag::planar, TiffTag::predictor, TiffTag::sample_format}) {
    if (!directory.has(tag) || (tag == TiffTag::predictor && !supports_predictor)) continue;
    std::uint16_t value = 0;
    const bool has_value = TIFFGetField(tiff, static_cast<std::uint32_t>(tag), &value) == 1;
    if (!has_value || value != directory.value(tag, 0)) throw_truncated_image();
  }
}

/// A file in memory, and libtiff's first message about it.
struct Source {
  ByteView file;
  std::size_t offset = 0;
  bool is_decoding = false;  ///< false while the file is opened
  std::array<char, 200> message{};

  void require(bool is_complete) const {
    if (!is_complete || message[0] != 0) throw_damaged_image(message.data());
  }
};

Source& source_of(void* handle) {
  return *static_cast<Source*>(handle);
}

tmsize_t read_bytes(thandle_t handle, void* buffer, tmsize_t count) {
  Source& source = source_of(handle);
  const std::size_t remaining = source.file.size() - std::min(source.offset, source.file.size());
  const std::size_t size = std::min(remaining, static_cast<std::size_t>(count));
  if (size > 0) std::memcpy(buffer, source.file.data() + source.offset, size);
  source.offset += size;
  return static_cast<tmsize_t>(size);
}

tmsize_t refuse_write(thandle_t /*handle*/, void* /*from*/, tmsize_t /*count*/) {
  return 0;
}

toff_t seek(thandle_t handle, toff_t offset, int origin) {
  Source& source = source_of(handle);
  if (origin == SEEK_CUR) offset += source.offset;
  if (origin == SEEK_END) offset += source.file.size();
  return source.offset = offset;
}

int ignore_close(thandle_t /*handle*/) {
  return 0;
}

toff_t size_of_file(thandle_t handle) {
  return source_of(handle).file.size();
}

/// Lets libtiff read samples in place, because it refuses uncompressed tiles that it must copy.
int map_file(thandle_t handle, void** start, toff_t* size) {
  const ByteView file = source_of(handle).file;
  *start = const_cast<std::uint8_t*>(file.data());
  *size = file.size();
  return 1;
}

void ignore_unmap(thandle_t /*handle*/, void* /*start*/, toff_t /*size*/) {}

constexpr int kHandled = 1;

/// Stores the first message.
[[gnu::format(printf, 4, 0)]] int store_error(TIFF* /*tiff*/, void* handle, const char* module,
                                              const char* format, va_list values) {
  auto& message = source_of(handle).message;
  if (message[0] != 0) return kHandled;
  const int prefix_length =
      std::snprintf(message.data(), message.size(), "%s: ", module != nullptr ? module : "libtiff");
  const auto start = std::min(static_cast<std::size_t>(std::max(prefix_length, 0)), message.size());
  std::vsnprintf(message.data() + start, message.size() - start, format, values);
  return kHandled;
}

/// Warnings on opening a file concern entries that affect no pixel or are checked here. Later
/// warnings mean that libtiff invented samples, except the one about old LZW, which it reads
/// correctly.
[[gnu::format(printf, 4, 0)]] int handle_warning(TIFF* tiff, void* handle, const char* module,
                                                 const char* format, va_list values) {
  const bool is_about_old_lzw = module != nullptr && std::string_view(module) == "LZWPreDecode";
  if (!source_of(handle).is_decoding || is_about_old_lzw) return kHandled;
  return store_error(tiff, handle, module, format, values);
}

using TiffFile = std::unique_ptr<TIFF, decltype(&TIFFClose)>;

/// \param directory  offset of the directory in the file
TiffFile open_tiff(Source& source, std::size_t directory) {
  // A picture takes at most eight bytes per pixel.
  constexpr tmsize_t kMaxBlock = 8 * kMaxImagePixels + (1 << 20U);
  const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(
      TIFFOpenOptionsAlloc(), TIFFOpenOptionsFree);
  if (!options) throw std::bad_alloc();
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), kMaxBlock);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), store_error, &source);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), handle_warning, &source);
  TiffFile tiff(
      TIFFClientOpenExt("picture", "rch", &source, read_bytes, refuse_write, seek, ignore_close,
                        size_of_file, map_file, ignore_unmap, options.get()),
      TIFFClose);
  if (!tiff || TIFFSetSubDirectory(tiff.get(), directory) == 0) {
    throw_damaged_image(source.message.data());
  }
  source.message.fill(0);
  source.is_decoding = true;
  return tiff;
}

/// libtiff's conversion of a picture to 8-bit RGBA.
struct Rgba : TIFFRGBAImage {
  explicit Rgba(TIFF* tiff) : TIFFRGBAImage() {
    std::array<char, 1024> error{};
    if (TIFFRGBAImageOK(tiff, error.data()) == 0 ||
        TIFFRGBAImageBegin(this, tiff, 1, error.data()) == 0) {
      throw_damaged_image(error.data());
    }
    orientation = req_orientation = ORIENTATION_TOPLEFT;
  }
  ~Rgba() { TIFFRGBAImageEnd(this); }
  Rgba(const Rgba&) = delete;
  Rgba& operator=(const Rgba&) = delete;
};

/// Reads colour, palettes and bilevel samples, which libtiff converts to 8-bit RGBA. If the file
/// declares straight alpha, libtiff premultiplies the colours and rounds like composite_on_black().
GreyImage read_as_rgba(TIFF* tiff, const Source& source, const Layout& layout,
                       std::uint64_t piece_height, Alpha alpha, GreyScale& scale) {
  Rgba rgba(tiff);
  source.require(rgba.width == layout.width && rgba.height == layout.height);
  GreyImage image(static_cast<int>(layout.height), static_cast<int>(layout.width));
  const auto max_rows =
      static_cast<std::uint32_t>(std::min<std::uint64_t>(piece_height, layout.height));
  std::vector<std::uint32_t> raster(std::size_t{layout.width} * max_rows);
  for (std::uint32_t y = 0; y < layout.height; y += max_rows) {
    rgba.row_offset = static_cast<int>(y);
    const std::uint32_t rows = std::min(max_rows, layout.height - y);
    source.require(TIFFRGBAImageGet(&rgba, raster.data(), layout.width, rows) == 1);
    const std::size_t first = std::size_t{y} * layout.width;
    for (std::size_t i = 0; i < std::size_t{rows} * layout.width; ++i) {
      std::array<std::uint8_t, 4> samples{};
      for (std::size_t k = 0; k < 4; ++k) {
        samples[k] = static_cast<std::uint8_t>(raster[i] >> (8 * k));
      }
      image.samples()[first + i] = scale.grey_of(samples.data(), 4, alpha);
    }
  }
  return image;
}

/// Reads the rows of strips or tiles with interleaved channels.
/// \param visit  called as visit(samples, y, x) for each row of a piece; y and x of its first pixel
template <typename Sample, typename Visit>
void read_rows(TIFF* tiff, const Source& source, const Layout& layout, const Pieces& pieces,
               const Visit& visit) {
  const std::size_t row_size = pieces.width * layout.channels;
  std::vector<Sample> piece(row_size * pieces.height);
  const std::uint64_t columns = ceil_divide(layout.width, pieces.width);
  for (std::uint32_t i = 0; i < pieces.count; ++i) {
    const std::uint64_t top = i / columns * pieces.height;
    const std::uint64_t left = i % columns * pieces.width;
    const auto size = static_cast<tmsize_t>(unpacked_size(layout, pieces, i / columns));
    source.require(size == (pieces.is_tiled ? TIFFReadEncodedTile(tiff, i, piece.data(), size)
                                            : TIFFReadEncodedStrip(tiff, i, piece.data(), size)));
    const std::uint64_t rows = std::min(pieces.height, layout.height - top);
    const std::uint64_t width = std::min(pieces.width, layout.width - left);
    for (std::uint64_t y = 0; y < rows; ++y) {
      visit(std::span(piece).subspan(y * row_size, width * layout.channels),
            static_cast<int>(top + y), static_cast<int>(left));
    }
  }
}

/// Reads 16-bit samples and 8-bit grey with alpha, because libtiff's conversion would lose
/// precision or alpha.
template <typename Sample>
GreyImage read_samples(TIFF* tiff, const Source& source, const Layout& layout, const Pieces& pieces,
                       Alpha alpha, GreyScale& scale) {
  GreyImage image(static_cast<int>(layout.height), static_cast<int>(layout.width));
  WideSamples stored_samples;  // before inversion
  read_rows<Sample>(tiff, source, layout, pieces, [&](std::span<Sample> row, int y, int x) {
    if (layout.photometric == PHOTOMETRIC_MINISWHITE) {
      // Inverts the colour before alpha is composited, because alpha is not inverted.
      const auto white = static_cast<Sample>(sizeof(Sample) == 2 && scale.bits() != 0
                                                 ? (1U << static_cast<unsigned>(scale.bits())) - 1U
                                                 : ~0U);
      for (std::size_t i = 0; i < row.size(); i += layout.channels) {
        stored_samples.add(row[i]);
        row[i] = static_cast<Sample>(white - std::min(row[i], white));
      }
    }
    scale.make_grey(
        row.data(), static_cast<int>(layout.channels), alpha,
        image.row(y).subspan(static_cast<std::size_t>(x), row.size() / layout.channels));
  });
  if (sizeof(Sample) == 2 && layout.photometric == PHOTOMETRIC_MINISWHITE) {
    scale.set_wide_samples(stored_samples);
  }
  return image;
}

/// Refuses markers of missing heights: NaN, infinite or implausibly large values, and the file's
/// no-data value, which programs write with six digits or more.
template <typename Real>
void refuse_gaps(std::span<const Real> heights, std::optional<double> gap) {
  constexpr double kMaxValue = 1e30;
  const double slack = gap ? 1e-6 * std::abs(*gap) : 0.0;
  const auto is_gap = [&](double h) {
    return !(std::abs(h) <= kMaxValue) || (gap && std::abs(h - *gap) <= slack);
  };
  const auto first = std::ranges::find_if(heights, is_gap);
  if (first == heights.end()) return;
  throw ImageFault{"has " + counted(std::ranges::count_if(heights, is_gap), "gap") + ", with " +
                       rounded(static_cast<double>(*first)) + " instead of a height",
                   "fill the gaps of the scan, or crop it to a part without gaps, and export it "
                   "again"};
}

/// Reads heights and scales the user's range, or else the picture's range, to grey levels.
/// \param gap  the no-data value
template <typename Real>
GreyImage read_heights(TIFF* tiff, const Source& source, const Layout& layout, const Pieces& pieces,
                       std::optional<double> gap, const GreyScale& scale, ImageNotes& notes) {
  Plane<Real> heights(static_cast<int>(layout.height), static_cast<int>(layout.width));
  read_rows<Real>(tiff, source, layout, pieces, [&](std::span<Real> row, int y, int x) {
    std::ranges::copy(row, heights.row(y).begin() + x);
  });
  refuse_gaps<Real>(heights.samples(), gap);
  const auto [lowest, highest] =
      std::minmax_element(heights.samples().begin(), heights.samples().end());
  notes.heights = {*lowest, *highest};
  const auto range = scale.heights().value_or(*notes.heights);
  const double low = range.first;
  const double high = range.second;
  notes.has_user_range = scale.heights().has_value();
  notes.cut_share = static_cast<double>(std::ranges::count_if(
                        heights.samples(), [&](Real h) { return h < low || h > high; })) /
                    static_cast<double>(heights.size());
  GreyImage image(heights.height(), heights.width());
  for (std::size_t i = 0; i < image.size(); ++i) {
    // A flat picture has no range.
    const double share = high > low ? (heights.samples()[i] - low) / (high - low) : 0.0;
    image.samples()[i] =
        static_cast<std::uint8_t>(std::floor(255.0 * std::clamp(share, 0.0, 1.0) + 0.5));
  }
  return image;
}

}  // namespace

GreyImage read_tiff(ByteView file, GreyScale& scale, ImageNotes& notes) {
  const TiffPictures pictures = pictures_of_tiff(file);
  notes.pictures = pictures.count;
  const TiffDirectory directory(file, pictures.first);
  const Layout layout = read_layout(directory);
  check_samples(directory, layout);
  const Pieces pieces = read_pieces(directory, layout);
  check_pieces(file, layout, pieces);
  Source source{.file = file};
  const TiffFile tiff = open_tiff(source, pictures.first);
  require_agreement(tiff.get(), directory, layout);
  const Alpha alpha = alpha_of(directory);
  if (layout.has_heights) {
    const auto gap = number_in<double>(directory.text(TiffTag::gdal_no_data));
    return layout.bits == 32
               ? read_heights<float>(tiff.get(), source, layout, pieces, gap, scale, notes)
               : read_heights<double>(tiff.get(), source, layout, pieces, gap, scale, notes);
  }
  if (layout.bits == 16) {
    return read_samples<std::uint16_t>(tiff.get(), source, layout, pieces, alpha, scale);
  }
  if (layout.channels == 2) {
    return read_samples<std::uint8_t>(tiff.get(), source, layout, pieces, alpha, scale);
  }
  // libtiff has composited an alpha channel that the file describes.
  const bool is_composited = directory.has(TiffTag::extra_samples) && alpha == Alpha::straight;
  return read_as_rgba(tiff.get(), source, layout, pieces.height,
                      is_composited ? Alpha::multiplied : alpha, scale);
}

}  // namespace touchtrial::engine
