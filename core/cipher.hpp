/// \file Sealed boxes for what must not be read before unblinding, and where secrets come from.
/// XChaCha20-Poly1305 (IETF) from libsodium. All functions may be called from any thread.
#pragma once

#include "core/bytes.hpp"
#include "core/hash.hpp"

#include <string_view>

namespace touchtrial {

using SecretKey = Digest;  ///< 32 secret bytes

/// Encrypts and authenticates. The nonce is a keyed hash of context and plaintext, so equal input
/// gives equal output and no nonce is ever used for two different messages under one key; callers
/// give every message its own context (chain, sequence), so equal messages stay unlinkable.
/// \param context  authenticated, not stored: the same bytes must be given to `unseal`
/// \param padded_size  the plaintext is padded to a multiple of this many bytes, >= 1, so that the
///   length tells nothing finer
/// \return nonce, ciphertext and tag in one buffer
[[nodiscard]] Bytes seal(const SecretKey& key, std::string_view context, ByteView plaintext,
                         std::size_t padded_size = 256);

/// \return the plaintext, or nothing if key, context, padding or a byte of the box is wrong
[[nodiscard]] std::optional<Bytes> unseal(const SecretKey& key, std::string_view context,
                                          ByteView box, std::size_t padded_size = 256);

/// A key for one purpose, derived from another; `purpose` is part of the file formats.
[[nodiscard]] SecretKey derive_key(const SecretKey& key, std::string_view purpose);

/// Where codes and secrets come from.
class Entropy {
 public:
  virtual ~Entropy() = default;
  /// 32 fresh bytes; `purpose` separates draws of a seeded source.
  [[nodiscard]] virtual SecretKey secret(std::string_view purpose) = 0;
};

/// The operating system's generator: what real studies use.
class SystemEntropy final : public Entropy {
 public:
  [[nodiscard]] SecretKey secret(std::string_view purpose) override;
};

/// A function of a seed and the purpose alone: what simulated studies use, and tests.
class SeededEntropy final : public Entropy {
 public:
  explicit SeededEntropy(std::uint64_t seed) : seed_(seed) {}
  [[nodiscard]] SecretKey secret(std::string_view purpose) override;

 private:
  std::uint64_t seed_;
};

}  // namespace touchtrial
