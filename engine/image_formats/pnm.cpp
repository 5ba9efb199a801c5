// Reads PGM and PPM files, as text or binary. The file states any maximum value, which determines
// the scale. If a file has several pictures, the first is read.
#include "engine/image_formats/image_format.hpp"

namespace touchtrial::engine {
namespace {

constexpr std::uint32_t kMaxSample = 65535;

bool is_space(std::uint8_t c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}
bool is_digit(std::uint8_t c) {
  return c >= '0' && c <= '9';
}

/// Reads numbers from a file, one after the other.
class Scanner {
 public:
  Scanner(ByteView file, std::size_t offset) : file_(file), offset_(offset) {}

  /// Reads the next decimal number, after white space and comments. Stops reading an absurdly long
  /// number.
  /// \throws ImageFault if there is none
  std::uint32_t read_decimal() {
    skip_space();
    constexpr std::uint32_t kLimit = 400'000'000;
    std::uint32_t number = 0;
    const std::size_t start = offset_;
    while (offset_ < file_.size() && is_digit(file_[offset_]) && number < kLimit) {
      number = number * 10 + (file_[offset_++] - std::uint32_t{'0'});
    }
    if (offset_ == start) throw_truncated_image();
    return number;
  }

  /// Skips the one white-space byte between the header and binary samples.
  void skip_header_end() {
    if (offset_ >= file_.size() || !is_space(file_[offset_])) throw_truncated_image();
    ++offset_;
  }

  std::uint32_t read_binary(std::size_t size) {
    const std::uint32_t number = number_at(file_, offset_, size, ByteOrder::big);
    offset_ += size;
    return number;
  }

  [[nodiscard]] std::size_t remaining_bytes() const { return file_.size() - offset_; }

 private:
  void skip_space() {
    while (offset_ < file_.size() && (is_space(file_[offset_]) || file_[offset_] == '#')) {
      if (file_[offset_] == '#')
        skip_comment();
      else
        ++offset_;
    }
  }
  void skip_comment() {
    while (offset_ < file_.size() && file_[offset_] != '\n' && file_[offset_] != '\r') ++offset_;
  }

  ByteView file_;
  std::size_t offset_;
};

struct SampleFormat {
  bool is_text = false;
  std::uint32_t channels = 1;
  std::uint32_t maximum = 0;

  [[nodiscard]] std::size_t size() const { return maximum > 255 ? 2 : 1; }
  /// The fewest bytes that can encode this many samples.
  [[nodiscard]] std::uint64_t bytes(std::uint64_t count) const {
    return is_text ? 2 * count - 1 : count * size();
  }
};

std::uint32_t next_sample(Scanner& scanner, const SampleFormat& format, GreyScale& scale) {
  const std::uint32_t sample =
      format.is_text ? scanner.read_decimal() : scanner.read_binary(format.size());
  if (sample > format.maximum) {
    throw ImageFault{"has a sample of " + std::to_string(sample) +
                         ", above its stated maximum of " + std::to_string(format.maximum),
                     "export it again"};
  }
  // A 12-bit file may state the maximum of 12 or of 16 bits.
  if (format.maximum == kMaxSample) {
    return scale.level_of(static_cast<std::uint16_t>(sample));
  }
  return to_8_bit(sample, format.maximum);
}

std::uint8_t next_pixel(Scanner& scanner, const SampleFormat& format, GreyScale& scale) {
  const std::uint32_t red_or_grey = next_sample(scanner, format, scale);
  if (format.channels == 1) return static_cast<std::uint8_t>(red_or_grey);
  const std::uint32_t green = next_sample(scanner, format, scale);
  return luma(red_or_grey, green, next_sample(scanner, format, scale));
}

}  // namespace

GreyImage read_pnm(ByteView file, GreyScale& scale) {
  const std::uint8_t kind = bytes_at(file, 0, 2)[1];
  Scanner scanner(file, 2);
  const std::uint32_t width = scanner.read_decimal();
  const std::uint32_t height = scanner.read_decimal();
  check_image_size(width, height);
  const SampleFormat format{kind == '2' || kind == '3', kind == '3' || kind == '6' ? 3U : 1U,
                            scanner.read_decimal()};
  if (format.maximum == 0 || format.maximum > kMaxSample) {
    throw ImageFault{
        "states a largest sample of " + std::to_string(format.maximum) + ", outside 1 .. 65535",
        "export it again"};
  }
  scanner.skip_header_end();
  if (format.bytes(std::uint64_t{width} * height * format.channels) > scanner.remaining_bytes()) {
    throw_truncated_image();
  }
  GreyImage image(static_cast<int>(height), static_cast<int>(width));
  for (std::uint8_t& pixel : image.samples()) pixel = next_pixel(scanner, format, scale);
  return image;
}

}  // namespace touchtrial::engine
