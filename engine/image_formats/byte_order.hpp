/// \file Numbers from the bytes of a file that may end too early.
#pragma once

#include "core/bytes.hpp"
#include "engine/image_formats/image_fault.hpp"

#include <cstddef>
#include <cstdint>

namespace touchtrial::engine {

enum class ByteOrder { little, big };

/// `count` bytes from `at` on. \throws ImageFault (truncated) if they are not all there
[[nodiscard]] inline ByteView bytes_at(ByteView bytes, std::size_t at, std::size_t count) {
  if (at > bytes.size() || count > bytes.size() - at) throw_truncated_image();
  return bytes.subspan(at, count);
}

/// An unsigned number of `size` (1 to 4) bytes. \throws ImageFault (truncated)
[[nodiscard]] inline std::uint32_t number_at(ByteView bytes, std::size_t at, std::size_t size,
                                             ByteOrder order) {
  const ByteView digits = bytes_at(bytes, at, size);
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < size; ++i) {
    number = number << 8U | digits[order == ByteOrder::big ? i : size - 1 - i];
  }
  return number;
}

[[nodiscard]] inline std::uint32_t big16(ByteView bytes, std::size_t at) {
  return number_at(bytes, at, 2, ByteOrder::big);
}
[[nodiscard]] inline std::uint32_t big32(ByteView bytes, std::size_t at) {
  return number_at(bytes, at, 4, ByteOrder::big);
}
[[nodiscard]] inline std::uint32_t little16(ByteView bytes, std::size_t at) {
  return number_at(bytes, at, 2, ByteOrder::little);
}
[[nodiscard]] inline std::uint32_t little32(ByteView bytes, std::size_t at) {
  return number_at(bytes, at, 4, ByteOrder::little);
}

}  // namespace touchtrial::engine
