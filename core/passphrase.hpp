/// \file Derives a key from a passphrase with Argon2id (RFC 9106) by libsodium. It costs time and
/// memory on purpose, because an attacker pays both for each guess. All functions are thread-safe.
#pragma once

#include "core/cipher.hpp"

#include <array>
#include <cstdint>
#include <string_view>

namespace touchtrial {

/// Random bytes, stored unencrypted, so that equal passphrases give different keys.
using Salt = std::array<std::uint8_t, 16>;

/// The cost of deriving one key.
struct PassphraseCost {
  std::uint64_t passes = 3;
  std::uint64_t memory_bytes = std::uint64_t{256} << 20U;

  friend bool operator==(const PassphraseCost&, const PassphraseCost&) = default;
};

/// The range of a cost that key_of_passphrase accepts. Files of this program never cost more than
/// the default, so a forged file cannot make every command run for hours.
inline constexpr PassphraseCost kMinPassphraseCost{1, std::uint64_t{8} << 10U};
inline constexpr PassphraseCost kMaxPassphraseCost{};
[[nodiscard]] bool is_in_range(const PassphraseCost& cost) noexcept;

/// \throws std::invalid_argument if a number of the cost is out of range
/// \throws std::bad_alloc if there is not enough memory
[[nodiscard]] SecretKey key_of_passphrase(std::string_view passphrase, const Salt& salt,
                                          const PassphraseCost& cost);

}  // namespace touchtrial
