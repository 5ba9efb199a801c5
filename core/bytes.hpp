/// \file Byte buffers and their text encodings, hexadecimal and base64.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial {

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

/// The bytes of a text, without a copy.
[[nodiscard]] inline ByteView bytes_of(std::string_view text) noexcept {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// The bytes as text, unchanged.
[[nodiscard]] inline std::string text_of(ByteView bytes) {
  return {bytes.begin(), bytes.end()};
}

/// Lower-case hexadecimal, two digits per byte.
[[nodiscard]] std::string to_hex(ByteView bytes);

/// \return the bytes, or nothing if `hex` has an odd length or a character that is not a
///   hexadecimal digit
[[nodiscard]] std::optional<Bytes> from_hex(std::string_view hex);

/// Base64 with the standard alphabet, padded (RFC 4648, section 4).
[[nodiscard]] std::string to_base64(ByteView bytes);

}  // namespace touchtrial
