#include "engine/image_formats/byte_order.hpp"
#include "engine/image_formats/decoder_input.hpp"

#include <algorithm>
#include <utility>

namespace touchtrial::engine {
namespace {

enum Marker : std::uint32_t {
  kStuffed = 0x00,
  kTemporary = 0x01,
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

struct Frame {
  std::uint32_t width = 0;  ///< 0: not seen yet
  std::uint32_t height = 0;
};

bool is_frame(std::uint32_t marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != kHuffmanTables && marker != kJpegExtension &&
         marker != kArithmeticTables;
}

bool is_baseline_or_progressive(std::uint32_t marker) {
  return marker >= 0xC0 && marker <= 0xC2;
}

/// Notes for other programs: profiles, thumbnails, orientation. JFIF and Adobe segments stay,
/// because they say how the channels are meant.
bool is_note(std::uint32_t marker) {
  return marker == kComment || (marker > kApp0 && marker <= kApp15 && marker != kApp14);
}

Frame read_frame(std::uint32_t marker, ByteView segment) {
  const Frame frame{big16(segment, 5), big16(segment, 3)};
  const std::uint32_t depth = number_at(segment, 2, 1, ByteOrder::big);
  const std::uint32_t channels = number_at(segment, 7, 1, ByteOrder::big);
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

/// Position of the next marker's 0xFF after entropy-coded data. \throws ImageFault if none comes
std::size_t end_of_scan_data(ByteView file, std::size_t at) {
  while (true) {
    const auto found = std::find(file.begin() + static_cast<std::ptrdiff_t>(at), file.end(), 0xFF);
    at = static_cast<std::size_t>(found - file.begin());
    const std::uint32_t next = number_at(file, at + 1, 1, ByteOrder::big);
    const bool inside = next == kStuffed || (next >= kRestart0 && next <= kRestart7);
    if (!inside && next != 0xFF) return at;
    at += inside ? 2 : 1;
  }
}

/// Walks the segments and copies what decides pixels.
class Walk {
 public:
  explicit Walk(ByteView file) : file_(file) { copy(0, 2); }

  /// \return false after the end marker
  bool step() {
    while (number_at(file_, at_ + 1, 1, ByteOrder::big) == 0xFF) ++at_;  // fill bytes
    if (number_at(file_, at_, 1, ByteOrder::big) != 0xFF) throw_truncated_image();
    const std::uint32_t marker = number_at(file_, at_ + 1, 1, ByteOrder::big);
    if (marker == kEnd) {
      copy(at_, 2);
      return false;
    }
    if (marker == kTemporary || (marker >= kRestart0 && marker <= kRestart7)) {
      at_ += 2;
      return true;
    }
    if (marker == kStart || marker == kStuffed) throw_truncated_image();
    segment(marker);
    return true;
  }

  /// \throws ImageFault unless the frame can be filled from the scans: a block takes a bit at least
  DecoderInput finish() {
    if (frame_.width == 0 || scan_bytes_ == 0) throw_truncated_image();
    const std::uint64_t blocks = std::uint64_t{(frame_.width + 7) / 8} * ((frame_.height + 7) / 8);
    if (blocks > scan_bytes_ * 8) throw_truncated_image();
    input_.width_px = static_cast<int>(frame_.width);
    input_.height_px = static_cast<int>(frame_.height);
    return std::move(input_);
  }

 private:
  void segment(std::uint32_t marker) {
    const std::size_t size = 2 + big16(file_, at_ + 2);
    const ByteView whole = bytes_at(file_, at_, size);
    if (size < 4) throw_truncated_image();
    if (is_frame(marker)) {
      if (frame_.width != 0) throw_truncated_image();
      frame_ = read_frame(marker, whole.subspan(2));
    }
    if (!is_note(marker)) copy(at_, size);
    at_ += size;
    if (marker == kScan) scan_data();
  }

  void scan_data() {
    const std::size_t end = end_of_scan_data(file_, at_);
    copy(at_, end - at_);
    scan_bytes_ += end - at_;
    at_ = end;
  }

  void copy(std::size_t at, std::size_t size) {
    const ByteView part = bytes_at(file_, at, size);
    input_.bytes.insert(input_.bytes.end(), part.begin(), part.end());
  }

  ByteView file_;
  std::size_t at_ = 2;
  Frame frame_;
  std::uint64_t scan_bytes_ = 0;
  DecoderInput input_;
};

}  // namespace

DecoderInput check_jpeg(ByteView file) {
  Walk walk(file);
  while (walk.step()) {
  }
  return walk.finish();
}

}  // namespace touchtrial::engine
