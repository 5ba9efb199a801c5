/// \file Hash functions. Seals and checksums use SHA-256, so that other programs can verify them.
/// Chains and traces use BLAKE2b, which is several times as fast. Keyed BLAKE2b gives tags that
/// only the holder of the key can compute. All functions are thread-safe.
#pragma once

#include "core/bytes.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>

namespace touchtrial {

using Digest = std::array<std::uint8_t, 32>;

/// SHA-256 (FIPS 180-4) of one buffer.
[[nodiscard]] Digest sha256(ByteView bytes);

/// SHA-256 of a file's content.
/// \throws FileError if it cannot be read
[[nodiscard]] Digest sha256_of_file(const std::filesystem::path& path);

/// BLAKE2b-256 (RFC 7693) of one buffer.
[[nodiscard]] Digest blake2b(ByteView bytes);

enum class HashFunction { sha256, blake2b };

/// Hash over a sequence of fields. Each field is preceded by its length in eight little-endian
/// bytes, so different sequences never give the same input.
class FieldHasher {
 public:
  explicit FieldHasher(HashFunction function = HashFunction::sha256);
  ~FieldHasher();
  FieldHasher(FieldHasher&&) noexcept;
  FieldHasher& operator=(FieldHasher&&) noexcept;

  FieldHasher& add(ByteView field);
  FieldHasher& add(std::string_view field) { return add(bytes_of(field)); }
  FieldHasher& add(std::int64_t number);

  /// The digest of all fields so far. The hasher must not be used afterwards.
  [[nodiscard]] Digest finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Keyed BLAKE2b-256: a pseudo-random function of `bytes` under `key`.
[[nodiscard]] Digest keyed_hash(const Digest& key, ByteView bytes);

[[nodiscard]] inline std::string to_hex(const Digest& digest) {
  return to_hex(ByteView(digest));
}

/// \return the digest, or nothing if `hex` is not 64 hexadecimal digits
[[nodiscard]] std::optional<Digest> digest_from_hex(std::string_view hex);

}  // namespace touchtrial
