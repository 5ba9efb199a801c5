/// \file The arithmetic of samples on their way to 8-bit grey. Source: docs/method.md, "Images".
#pragma once

#include <cstdint>

namespace touchtrial::engine {

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
[[nodiscard]] constexpr std::uint32_t over_black(std::uint32_t colour,
                                                 std::uint32_t alpha) noexcept {
  return (2U * colour * alpha + 255U) / 510U;
}

/// floor((299 R + 587 G + 114 B + 500) / 1000)
[[nodiscard]] constexpr std::uint8_t luma(std::uint32_t red, std::uint32_t green,
                                          std::uint32_t blue) noexcept {
  return static_cast<std::uint8_t>((299U * red + 587U * green + 114U * blue + 500U) / 1000U);
}

}  // namespace touchtrial::engine
