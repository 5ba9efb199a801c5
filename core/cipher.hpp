/// \file Encrypts records that stay hidden until unblinding, and generates their secret keys.
/// XChaCha20-Poly1305 (IETF) by libsodium. All functions are thread-safe.
#pragma once

#include "core/bytes.hpp"
#include "core/hash.hpp"

#include <string_view>

namespace touchtrial {

using SecretKey = Digest;  ///< 32 secret bytes

/// Encrypts and authenticates. The nonce is a keyed hash of context and plaintext, so equal input
/// gives equal output, and two different messages under one key never share a nonce. Callers give
/// every message its own context (chain, sequence), so equal messages stay unlinkable.
/// \param context  authenticated, not stored: `unseal` needs the same bytes
/// \param padded_size  bytes, >= 1: the plaintext is padded to a multiple of this size, to hide its
///   length
/// \return nonce, ciphertext and tag in one buffer
/// \throws std::invalid_argument if padded_size is 0
[[nodiscard]] Bytes seal(const SecretKey& key, std::string_view context, ByteView plaintext,
                         std::size_t padded_size = 256);

/// Decrypts a box returned by `seal`.
/// \return the plaintext, or nothing if key, context, padding or a byte of the box is wrong
/// \throws std::invalid_argument if padded_size is 0
[[nodiscard]] std::optional<Bytes> unseal(const SecretKey& key, std::string_view context,
                                          ByteView box, std::size_t padded_size = 256);

/// Decrypts many boxes sealed with the same key.
class Unsealer {
 public:
  explicit Unsealer(const SecretKey& key);
  [[nodiscard]] std::optional<Bytes> operator()(std::string_view context, ByteView box,
                                                std::size_t padded_size) const;

 private:
  SecretKey cipher_key_;
};

/// Derives the key for one purpose from another key. The purposes are part of the file formats.
[[nodiscard]] SecretKey derive_key(const SecretKey& key, std::string_view purpose);

/// A source of codes and secrets.
class Entropy {
 public:
  virtual ~Entropy() = default;
  /// 32 fresh bytes. A seeded source gives different bytes for different purposes.
  [[nodiscard]] virtual SecretKey secret(std::string_view purpose) = 0;
};

/// The operating system's generator, for real studies.
class SystemEntropy final : public Entropy {
 public:
  [[nodiscard]] SecretKey secret(std::string_view purpose) override;
};

/// Depends only on a seed and the purpose; for simulated studies and tests.
class SeededEntropy final : public Entropy {
 public:
  explicit SeededEntropy(std::uint64_t seed) : seed_(seed) {}
  [[nodiscard]] SecretKey secret(std::string_view purpose) override;

 private:
  std::uint64_t seed_;
};

}  // namespace touchtrial
