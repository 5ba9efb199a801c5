#include "engine/image_file.hpp"
#include "engine/image_formats/escape.hpp"
#include "engine/image_formats/image_format.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <new>
#include <utility>

// libjpeg's headers need <cstdio> before them.
#include <jerror.h>
#include <jpeglib.h>

namespace touchtrial::engine {
namespace {

enum Marker : std::uint32_t {
  kStuffed = 0x00,
  kTemporary = 0x01,
  kProgressive = 0xC2,
  kHuffmanTables = 0xC4,
  kJpegExtension = 0xC8,
  kArithmeticTables = 0xCC,
  kRestart0 = 0xD0,
  kRestart7 = 0xD7,
  kStart = 0xD8,
  kEnd = 0xD9,
  kScan = 0xDA,
  kApp0 = 0xE0,
  kApp14 = 0xEE,
  kApp15 = 0xEF,
  kComment = 0xFE,
};

/// More scans than any encoder writes. Each scan of a progressive file covers the whole picture.
constexpr int kMaxScans = 100;
/// Suffices for the coefficients of the largest progressive picture and for libjpeg's tables.
constexpr long kMaxMemory = 6L * kMaxImagePixels + (1L << 28U);

struct Frame {
  std::uint32_t width = 0;  ///< 0: not seen yet
  std::uint32_t height = 0;
  std::uint32_t channels = 0;
  bool is_progressive = false;

  [[nodiscard]] std::uint64_t samples() const {
    return std::uint64_t{width + 7} * (height + 7) * channels;
  }
};

/// A coefficient has at most 16 bits of code and 11 of value, which byte stuffing can double.
constexpr std::uint64_t kMaxBytesPerSample = 8;

bool is_frame(std::uint32_t marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != kHuffmanTables && marker != kJpegExtension &&
         marker != kArithmeticTables;
}

bool is_baseline_or_progressive(std::uint32_t marker) {
  return marker >= 0xC0 && marker <= 0xC2;
}

/// Whether a segment contains only metadata: profiles, thumbnails, orientation. JFIF and Adobe
/// segments define the meaning of the channels.
bool is_metadata(std::uint32_t marker) {
  return marker == kComment || (marker > kApp0 && marker <= kApp15 && marker != kApp14);
}

Frame read_frame(std::uint32_t marker, ByteView segment) {
  const std::uint32_t depth = number_at(segment, 2, 1, ByteOrder::big);
  const std::uint32_t channels = number_at(segment, 7, 1, ByteOrder::big);
  const Frame frame{big16(segment, 5), big16(segment, 3), channels, marker == kProgressive};
  check_image_size(frame.width, frame.height);
  if (!is_baseline_or_progressive(marker)) {
    throw_unsupported_image(
        "is a lossless, hierarchical or arithmetic-coded JPEG, which is not supported");
  }
  if (depth != 8) throw_unsupported_image("is a JPEG of more than 8 bits, which is not supported");
  if (channels != 1 && channels != 3) {
    throw_unsupported_image("is a JPEG of " + std::to_string(channels) +
                            " channels (CMYK?), which is not supported");
  }
  return frame;
}

/// The position of the 0xFF of the next marker after entropy-coded data, or the file's end.
/// \throws ImageFault if the file ends within a marker
std::size_t end_of_scan_data(ByteView file, std::size_t offset) {
  while (true) {
    const auto marker =
        std::find(file.begin() + static_cast<std::ptrdiff_t>(offset), file.end(), 0xFF);
    offset = static_cast<std::size_t>(marker - file.begin());
    if (offset + 1 >= file.size()) return offset;  // at most half of a marker follows
    const std::uint32_t next_byte = number_at(file, offset + 1, 1, ByteOrder::big);
    const bool is_data =
        next_byte == kStuffed || (next_byte >= kRestart0 && next_byte <= kRestart7);
    if (!is_data && next_byte != 0xFF) return offset;
    offset += is_data ? 2 : 1;
  }
}

/// Copies the segments that affect pixels.
class SegmentFilter {
 public:
  explicit SegmentFilter(ByteView file) : file_(file) { copy(0, 2); }

  /// \return false after the end marker
  bool step() {
    if (offset_ + 1 >= file_.size() && is_complete_without_end()) {
      lacks_end_ = true;
      return false;
    }
    while (number_at(file_, offset_ + 1, 1, ByteOrder::big) == 0xFF) ++offset_;  // fill bytes
    if (number_at(file_, offset_, 1, ByteOrder::big) != 0xFF) throw_truncated_image();
    const std::uint32_t marker = number_at(file_, offset_ + 1, 1, ByteOrder::big);
    if (marker == kEnd) return false;
    if (marker == kTemporary || (marker >= kRestart0 && marker <= kRestart7)) {
      offset_ += 2;
      return true;
    }
    if (marker == kStart || marker == kStuffed) throw_truncated_image();
    read_segment(marker);
    return true;
  }

  /// The file with only the segments that affect pixels.
  /// \throws ImageFault if the scans are too short to fill the frame: a block takes at least one
  ///   bit
  Bytes finish() {
    if (frame_.width == 0 || scan_bytes_ == 0) throw_truncated_image();
    const std::uint64_t blocks = std::uint64_t{(frame_.width + 7) / 8} * ((frame_.height + 7) / 8);
    if (blocks > scan_bytes_ * 8) throw_truncated_image();
    output_.insert(output_.end(), {0xFF, kEnd});
    return std::move(output_);
  }

  [[nodiscard]] bool lacks_end() const noexcept { return lacks_end_; }

 private:
  /// Some programs omit the end marker. The file is then complete if one scan has all channels;
  /// libjpeg reports any missing block.
  [[nodiscard]] bool is_complete_without_end() const {
    return scans_ == 1 && !frame_.is_progressive && channels_of_scan_ == frame_.channels;
  }

  void read_segment(std::uint32_t marker) {
    const std::size_t size = 2 + big16(file_, offset_ + 2);
    const ByteView bytes = bytes_at(file_, offset_, size);
    if (size < 4) throw_truncated_image();
    if (is_frame(marker)) {
      if (frame_.width != 0) throw_truncated_image();
      frame_ = read_frame(marker, bytes.subspan(2));
    }
    if (!is_metadata(marker)) copy(offset_, size);
    offset_ += size;
    if (marker != kScan) return;
    channels_of_scan_ = number_at(bytes, 4, 1, ByteOrder::big);
    read_scan_data();
  }

  void read_scan_data() {
    if (++scans_ > kMaxScans) {
      throw ImageFault{"is a JPEG of more than " + std::to_string(kMaxScans) + " scans",
                       "export it again"};
    }
    const std::size_t end = end_of_scan_data(file_, offset_);
    // This is checked before copying, because the data may be huge.
    if (end + 1 >= file_.size() && end - offset_ > kMaxBytesPerSample * frame_.samples()) {
      throw_truncated_image();
    }
    copy(offset_, end - offset_);
    scan_bytes_ += end - offset_;
    offset_ = end;
  }

  void copy(std::size_t offset, std::size_t size) {
    const ByteView part = bytes_at(file_, offset, size);
    output_.insert(output_.end(), part.begin(), part.end());
  }

  ByteView file_;
  std::size_t offset_ = 2;
  Frame frame_;
  std::uint64_t scan_bytes_ = 0;
  std::uint32_t channels_of_scan_ = 0;  ///< of the last scan
  int scans_ = 0;
  bool lacks_end_ = false;
  Bytes output_;
};

[[noreturn]] void leave(j_common_ptr jpeg) {
  std::array<char, JMSG_LENGTH_MAX> text{};
  jpeg->err->format_message(jpeg, text.data());
  static_cast<Escape*>(jpeg->client_data)->leave(text.data());
}

/// Some cameras write a few padding bytes before the end marker. The other harmless messages
/// concern only the file's declared version and colour transform.
bool is_harmless(const jpeg_error_mgr& error) {
  constexpr int kMaxPadding = 16;
  if (error.msg_code == JWRN_ADOBE_XFORM || error.msg_code == JWRN_JFIF_MAJOR) return true;
  return error.msg_code == JWRN_EXTRANEOUS_DATA && error.msg_parm.i[0] <= kMaxPadding &&
         error.msg_parm.i[1] == static_cast<int>(kEnd);
}

/// Levels below 0 are warnings, after which libjpeg would continue with invented samples.
void handle_message(j_common_ptr jpeg, int level) {
  if (level < 0 && !is_harmless(*jpeg->err)) leave(jpeg);
}

/// Decodes a file in memory with libjpeg.
class JpegDecoder {
 public:
  explicit JpegDecoder(GreyScale& scale) : scale_(scale) {
    jpeg_.err = jpeg_std_error(&errors_);
    jpeg_.client_data = &escape_;
    errors_.error_exit = leave;
    errors_.emit_message = handle_message;
  }
  ~JpegDecoder() { jpeg_destroy_decompress(&jpeg_); }
  JpegDecoder(const JpegDecoder&) = delete;
  JpegDecoder& operator=(const JpegDecoder&) = delete;

  GreyImage read(ByteView file) {
    require(run_guarded(escape_, [&] { read_start(file); }));
    GreyImage image(static_cast<int>(jpeg_.output_height), static_cast<int>(jpeg_.output_width));
    const int channels = jpeg_.output_components;
    Bytes samples(std::size_t{jpeg_.output_width} * static_cast<std::size_t>(channels));
    require(run_guarded(escape_, [&] {
      for (int y = 0; y < image.height(); ++y) {
        JSAMPROW row = samples.data();
        jpeg_read_scanlines(&jpeg_, &row, 1);
        scale_.make_grey(samples.data(), channels, Alpha::none, image.row(y));
      }
      jpeg_finish_decompress(&jpeg_);
    }));
    return image;
  }

 private:
  void require(bool is_complete) const {
    if (is_complete) return;
    if (errors_.msg_code == JERR_OUT_OF_MEMORY) throw std::bad_alloc();
    throw_damaged_image(escape_.message.data());
  }

  void read_start(ByteView file) {
    jpeg_create_decompress(&jpeg_);
    jpeg_.mem->max_memory_to_use = kMaxMemory;
    jpeg_mem_src(&jpeg_, file.data(), file.size());
    jpeg_read_header(&jpeg_, TRUE);
    jpeg_.out_color_space = jpeg_.num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_start_decompress(&jpeg_);
  }

  GreyScale& scale_;
  Escape escape_;
  jpeg_error_mgr errors_{};
  jpeg_decompress_struct jpeg_{};
};

}  // namespace

GreyImage read_jpeg(ByteView file, GreyScale& scale, ImageNotes& notes) {
  SegmentFilter filter(file);
  while (filter.step()) {
  }
  const Bytes pixel_segments = filter.finish();
  notes.lacks_end = filter.lacks_end();
  return JpegDecoder(scale).read(pixel_segments);
}

}  // namespace touchtrial::engine
