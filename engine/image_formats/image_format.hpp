/// \file The readers of all kinds of pictures, and shared helpers for faults, numbers in files and
/// conversion of samples to 8-bit grey. Source of the conversion: docs/method.md, "Images".
#pragma once

#include "core/bytes.hpp"
#include "core/plane.hpp"
#include "engine/image_file.hpp"
#include "engine/image_notes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <utility>

namespace touchtrial::engine {

enum class ImageKind { png, jpeg, tiff, bmp, gif, pnm };

/// Recognises a picture by the first bytes of its file.
/// \throws ImageFault if it is not a picture of a supported kind
[[nodiscard]] ImageKind kind_of_image(ByteView file);

class GreyScale;

/// These functions decode a file of one kind. They ignore metadata, including orientation and
/// colour profiles, allocate memory only if the structure of the file shows that the samples exist,
/// and print nothing. Thread-safe.
/// \param notes  receives the number of pictures, and whether the end marker is missing
/// \throws ImageFault if the file is truncated, damaged, too large or of an unsupported type
[[nodiscard]] GreyImage read_png(ByteView file, GreyScale& scale);
[[nodiscard]] GreyImage read_jpeg(ByteView file, GreyScale& scale, ImageNotes& notes);
[[nodiscard]] GreyImage read_tiff(ByteView file, GreyScale& scale, ImageNotes& notes);
[[nodiscard]] GreyImage read_bmp(ByteView file, GreyScale& scale);
[[nodiscard]] GreyImage read_gif(ByteView file, GreyScale& scale, ImageNotes& notes);
[[nodiscard]] GreyImage read_pnm(ByteView file, GreyScale& scale);

/// Width and height of a PNG, pixels, from its header only.
/// \throws ImageFault
[[nodiscard]] std::pair<int, int> size_of_png(ByteView file);

/// A PNG file of 8-bit samples, with zlib's best compression.
/// \param channels  1: grey, 3: red, green, blue
/// \param samples  rows from the top, height * width * channels
/// \throws ImageFault if libpng refuses
[[nodiscard]] Bytes png_of_samples(int height, int width, int channels,
                                   std::span<const std::uint8_t> samples);

/// A fault of a picture. The caller adds the file's name.
struct ImageFault {
  std::string what;    ///< the rest of a sentence that starts with the file's name
  std::string remedy;  ///< what the user can do
};

[[noreturn]] void throw_truncated_image();
/// \param message  the library's message; may be empty
[[noreturn]] void throw_damaged_image(const std::string& message);
[[noreturn]] void throw_unsupported_image(const std::string& what);

/// The longest side of a picture; also libpng's limit.
inline constexpr std::int64_t kMaxSidePx = 1'000'000;

/// Refuses an empty or too large picture from its header only.
/// \throws ImageFault
void check_image_size(std::int64_t width_px, std::int64_t height_px);

enum class ByteOrder { little, big };

/// Returns `count` bytes from an offset.
/// \throws ImageFault (truncated) if the buffer is too short
[[nodiscard]] ByteView bytes_at(ByteView bytes, std::size_t offset, std::size_t count);

/// Returns an unsigned number of `size` (1 to 4) bytes.
/// \throws ImageFault (truncated)
[[nodiscard]] std::uint32_t number_at(ByteView bytes, std::size_t offset, std::size_t size,
                                      ByteOrder order);

[[nodiscard]] inline std::uint32_t big16(ByteView bytes, std::size_t offset) {
  return number_at(bytes, offset, 2, ByteOrder::big);
}
[[nodiscard]] inline std::uint32_t big32(ByteView bytes, std::size_t offset) {
  return number_at(bytes, offset, 4, ByteOrder::big);
}
[[nodiscard]] inline std::uint32_t little16(ByteView bytes, std::size_t offset) {
  return number_at(bytes, offset, 2, ByteOrder::little);
}
[[nodiscard]] inline std::uint32_t little32(ByteView bytes, std::size_t offset) {
  return number_at(bytes, offset, 4, ByteOrder::little);
}

/// floor(v / 257 + 0.5) for a 16-bit sample; an 8-bit sample is itself.
[[nodiscard]] constexpr std::uint32_t to_8_bit(std::uint16_t sample) noexcept {
  return (2U * sample + 257U) / 514U;
}
[[nodiscard]] constexpr std::uint32_t to_8_bit(std::uint8_t sample) noexcept {
  return sample;
}

/// A sample of any maximum, rounded to the nearest of 0 .. 255: floor(v * 255 / maximum + 0.5).
[[nodiscard]] constexpr std::uint8_t to_8_bit(std::uint32_t sample,
                                              std::uint32_t maximum) noexcept {
  return static_cast<std::uint8_t>((2U * 255U * sample + maximum) / (2U * maximum));
}

/// floor(colour * alpha / 255 + 0.5): alpha composited on black.
[[nodiscard]] constexpr std::uint32_t composite_on_black(std::uint32_t colour,
                                                         std::uint32_t alpha) noexcept {
  return (2U * colour * alpha + 255U) / 510U;
}

/// floor((299 R + 587 G + 114 B + 500) / 1000)
[[nodiscard]] constexpr std::uint8_t luma(std::uint32_t red, std::uint32_t green,
                                          std::uint32_t blue) noexcept {
  return static_cast<std::uint8_t>((299U * red + 587U * green + 114U * blue + 500U) / 1000U);
}

/// The meaning of the last of two or four channels.
enum class Alpha {
  straight,    ///< opacity; the pixel is composited on black
  multiplied,  ///< opacity, with premultiplied colours
  none,        ///< something else
};

/// A histogram of 16-bit samples by number of bits.
class WideSamples {
 public:
  void add(std::uint32_t sample) noexcept {
    ++counts_[static_cast<std::size_t>(std::bit_width(sample))];
  }
  /// The number of samples that need more than this many bits.
  [[nodiscard]] std::uint64_t count_above(int bits) const noexcept {
    return std::accumulate(counts_.begin() + bits + 1, counts_.end(), std::uint64_t{0});
  }
  [[nodiscard]] std::uint64_t count() const noexcept { return counts_[0] + count_above(0); }
  /// The number of bits used by all but at most one sample in a thousand: hot pixels use all bits.
  [[nodiscard]] int bits() const noexcept {
    int bits = 16;
    while (bits > 0 && count_above(bits - 1) * 1000 <= count()) --bits;
    return bits;
  }

 private:
  std::array<std::uint64_t, 17> counts_{};
};

/// Converts the samples of one picture to 8-bit grey and counts wide and transparent samples.
class GreyScale {
 public:
  explicit GreyScale(const SampleScale& samples) noexcept
      : bits_(samples.bits), heights_(samples.heights) {}

  /// Switches to opacity: opaque pixels become 255 and all others 0.
  void show_opacity() noexcept { shows_opacity_ = true; }

  std::uint32_t level_of(std::uint8_t sample) noexcept { return sample; }
  std::uint32_t level_of(std::uint16_t sample) noexcept {
    wide_samples_.add(sample);
    if (bits_ == 0) return to_8_bit(sample);
    const std::uint32_t maximum = (1U << static_cast<unsigned>(bits_)) - 1U;
    return to_8_bit(std::min<std::uint32_t>(sample, maximum), maximum);
  }

  /// One pixel of 8- or 16-bit samples: grey, grey alpha, RGB or RGBA.
  template <typename Sample>
  [[nodiscard]] std::uint8_t grey_of(const Sample* pixel, int channels, Alpha alpha) noexcept {
    const bool has_alpha = channels % 2 == 0 && alpha != Alpha::none;
    // Alpha may use 16 bits even where colour uses fewer, so it is left out of the histogram.
    std::uint32_t opacity = has_alpha ? to_8_bit(pixel[channels - 1]) : 255U;
    if (opacity < 255U) ++transparent_pixels_;
    if (shows_opacity_) return opacity < 255U ? 0 : 255;
    if (alpha == Alpha::multiplied) opacity = 255U;
    const auto visible = [&](int channel) {
      return composite_on_black(level_of(pixel[channel]), opacity);
    };
    if (channels <= 2) return static_cast<std::uint8_t>(visible(0));
    return luma(visible(0), visible(1), visible(2));
  }

  /// A row of such pixels.
  template <typename Sample>
  void make_grey(const Sample* pixel, int channels, Alpha alpha,
                 std::span<std::uint8_t> row) noexcept {
    for (std::uint8_t& grey : row) {
      grey = grey_of(pixel, channels, alpha);
      pixel += channels;
    }
  }

  /// Replaces the histogram with one of the samples before inversion.
  void set_wide_samples(const WideSamples& samples) noexcept { wide_samples_ = samples; }

  [[nodiscard]] int bits() const noexcept { return bits_; }
  [[nodiscard]] const std::optional<std::pair<double, double>>& heights() const noexcept {
    return heights_;
  }
  [[nodiscard]] const WideSamples& wide_samples() const noexcept { return wide_samples_; }
  [[nodiscard]] std::uint64_t transparent_pixels() const noexcept { return transparent_pixels_; }

 private:
  int bits_;
  std::optional<std::pair<double, double>> heights_;
  WideSamples wide_samples_;
  bool shows_opacity_ = false;
  std::uint64_t transparent_pixels_ = 0;
};

}  // namespace touchtrial::engine
