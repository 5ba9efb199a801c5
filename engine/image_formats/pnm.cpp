// PGM and PPM, as text or binary, of any maximum value, which determines the scale. If a file has
// several pictures, the first is read.
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
  Scanner(ByteView file, std::size_t at) : file_(file), at_(at) {}

  /// The next decimal number, after white space and comments. A number that is absurdly long ends
  /// early.
  /// \throws ImageFault if there is none
  std::uint32_t decimal() {
    skip_space();
    constexpr std::uint32_t kLimit = 400'000'000;
    std::uint32_t number = 0;
    const std::size_t start = at_;
    while (at_ < file_.size() && is_digit(file_[at_]) && number < kLimit) {
      number = number * 10 + (file_[at_++] - std::uint32_t{'0'});
    }
    if (at_ == start) throw_truncated_image();
    return number;
  }

  /// Exactly one white-space byte stands between the header and binary samples.
  void end_of_header() {
    if (at_ >= file_.size() || !is_space(file_[at_])) throw_truncated_image();
    ++at_;
  }

  std::uint32_t binary(std::size_t size) {
    const std::uint32_t number = number_at(file_, at_, size, ByteOrder::big);
    at_ += size;
    return number;
  }

  [[nodiscard]] std::size_t left() const { return file_.size() - at_; }

 private:
  void skip_space() {
    while (at_ < file_.size() && (is_space(file_[at_]) || file_[at_] == '#')) {
      if (file_[at_] == '#')
        skip_comment();
      else
        ++at_;
    }
  }
  void skip_comment() {
    while (at_ < file_.size() && file_[at_] != '\n' && file_[at_] != '\r') ++at_;
  }

  ByteView file_;
  std::size_t at_;
};

struct Samples {
  bool text = false;
  std::uint32_t channels = 1;
  std::uint32_t maximum = 0;

  [[nodiscard]] std::size_t size() const { return maximum > 255 ? 2 : 1; }
  /// The fewest bytes that can hold this many samples.
  [[nodiscard]] std::uint64_t bytes(std::uint64_t count) const {
    return text ? 2 * count - 1 : count * size();
  }
};

std::uint32_t next_sample(Scanner& scanner, const Samples& samples, GreyScale& scale) {
  const std::uint32_t sample = samples.text ? scanner.decimal() : scanner.binary(samples.size());
  if (sample > samples.maximum) {
    throw ImageFault{"has a sample of " + std::to_string(sample) +
                         ", above its stated maximum of " + std::to_string(samples.maximum),
                     "export it again"};
  }
  // A file of 12 bits may state that as its maximum, or state 16 bits.
  if (samples.maximum == kMaxSample) {
    return scale.level_of(static_cast<std::uint16_t>(sample));
  }
  return to_8_bit(sample, samples.maximum);
}

std::uint8_t next_pixel(Scanner& scanner, const Samples& samples, GreyScale& scale) {
  const std::uint32_t first = next_sample(scanner, samples, scale);
  if (samples.channels == 1) return static_cast<std::uint8_t>(first);
  const std::uint32_t green = next_sample(scanner, samples, scale);
  return luma(first, green, next_sample(scanner, samples, scale));
}

}  // namespace

GreyImage read_pnm(ByteView file, GreyScale& scale) {
  const std::uint8_t kind = bytes_at(file, 0, 2)[1];
  Scanner scanner(file, 2);
  const std::uint32_t width = scanner.decimal();
  const std::uint32_t height = scanner.decimal();
  check_image_size(width, height);
  const Samples samples{kind == '2' || kind == '3', kind == '3' || kind == '6' ? 3U : 1U,
                        scanner.decimal()};
  if (samples.maximum == 0 || samples.maximum > kMaxSample) {
    throw ImageFault{
        "states a largest sample of " + std::to_string(samples.maximum) + ", outside 1 .. 65535",
        "export it again"};
  }
  scanner.end_of_header();
  if (samples.bytes(std::uint64_t{width} * height * samples.channels) > scanner.left()) {
    throw_truncated_image();
  }
  GreyImage image(static_cast<int>(height), static_cast<int>(width));
  for (std::uint8_t& pixel : image.samples()) pixel = next_pixel(scanner, samples, scale);
  return image;
}

}  // namespace touchtrial::engine
