/// \file Public-key sealing and signing: one half of a key pair opens or verifies what the other
/// half sealed or signed. X25519 with XSalsa20-Poly1305 (crypto_box) and Ed25519, both by
/// libsodium. All functions are thread-safe.
#pragma once

#include "core/cipher.hpp"

#include <array>
#include <optional>
#include <string_view>

namespace touchtrial {

using PublicKey = Digest;  ///< 32 bytes, not secret

/// Opens boxes that were sealed with the public half.
struct BoxKeys {
  PublicKey public_half{};
  SecretKey secret_half{};
};

/// Derives the keys from a seed.
[[nodiscard]] BoxKeys box_keys(const SecretKey& seed);

/// Seals a text for the holder of the secret half; the sealer cannot open it again.
/// \param context  `open_box` needs the same bytes
/// \param ephemeral  fresh secret bytes, or a secret function of the plaintext; never used twice
///   for different plaintexts
[[nodiscard]] Bytes seal_box(const PublicKey& receiver, std::string_view context,
                             ByteView plaintext, const SecretKey& ephemeral);
/// \return the plaintext, or nothing if keys, context or a byte of the box is wrong
[[nodiscard]] std::optional<Bytes> open_box(const BoxKeys& receiver, std::string_view context,
                                            ByteView box);

using Signature = std::array<std::uint8_t, 64>;

/// Signs messages, which anyone can verify with the public half.
class Signer {
 public:
  /// Derives the keys from a seed.
  explicit Signer(const SecretKey& seed);

  [[nodiscard]] const PublicKey& public_half() const noexcept { return public_half_; }
  [[nodiscard]] Signature sign(ByteView message) const;

 private:
  PublicKey public_half_{};
  std::array<std::uint8_t, 64> secret_half_{};
};

/// The bytes that the investigator signs for a station: study, station name, and public key.
[[nodiscard]] Bytes station_statement(std::string_view study_id, std::string_view name,
                                      const PublicKey& station);

[[nodiscard]] bool is_signed_by(const PublicKey& signer, ByteView message, ByteView signature);

}  // namespace touchtrial
