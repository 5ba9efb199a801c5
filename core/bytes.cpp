#include "core/bytes.hpp"

#include <sodium.h>

namespace touchtrial {

std::string to_hex(ByteView bytes) {
  std::string hex(2 * bytes.size() + 1, '\0');
  sodium_bin2hex(hex.data(), hex.size(), bytes.data(), bytes.size());
  hex.pop_back();
  return hex;
}

std::optional<Bytes> from_hex(std::string_view hex) {
  if (hex.size() % 2 != 0) return std::nullopt;
  Bytes bytes(hex.size() / 2);
  std::size_t byte_count = 0;
  const char* end = nullptr;
  const int status = sodium_hex2bin(bytes.data(), bytes.size(), hex.data(), hex.size(), nullptr,
                                    &byte_count, &end);
  if (status != 0 || end != hex.data() + hex.size() || byte_count != bytes.size())
    return std::nullopt;
  return bytes;
}

std::string to_base64(ByteView bytes) {
  constexpr int kVariant = sodium_base64_VARIANT_ORIGINAL;
  std::string text(sodium_base64_encoded_len(bytes.size(), kVariant), '\0');
  sodium_bin2base64(text.data(), text.size(), bytes.data(), bytes.size(), kVariant);
  text.pop_back();  // the encoder's terminating zero
  return text;
}

}  // namespace touchtrial
