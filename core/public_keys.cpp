#include "core/public_keys.hpp"

#include "core/sodium.hpp"

#include <algorithm>
#include <stdexcept>

#include <sodium.h>

namespace touchtrial {
namespace {

using BoxNonce = std::array<std::uint8_t, crypto_box_NONCEBYTES>;

/// Derives the nonce from the keys. It never repeats, because each ephemeral key seals one message.
BoxNonce nonce_of(const PublicKey& ephemeral, const PublicKey& receiver, std::string_view context) {
  const Digest identity = FieldHasher().add(ephemeral).add(receiver).add(context).finish();
  BoxNonce nonce{};
  std::copy_n(identity.begin(), nonce.size(), nonce.begin());
  return nonce;
}

}  // namespace

BoxKeys box_keys(const SecretKey& seed) {
  prepare_sodium();
  BoxKeys keys;
  crypto_box_seed_keypair(keys.public_half.data(), keys.secret_half.data(), seed.data());
  return keys;
}

Bytes seal_box(const PublicKey& receiver, std::string_view context, ByteView plaintext,
               const SecretKey& ephemeral) {
  const BoxKeys sender = box_keys(ephemeral);
  const BoxNonce nonce = nonce_of(sender.public_half, receiver, context);
  Bytes box(sender.public_half.begin(), sender.public_half.end());
  box.resize(box.size() + crypto_box_MACBYTES + plaintext.size());
  const int status =
      crypto_box_easy(box.data() + sender.public_half.size(), plaintext.data(), plaintext.size(),
                      nonce.data(), receiver.data(), sender.secret_half.data());
  if (status != 0) throw std::invalid_argument("seal_box: invalid public key");
  return box;
}

std::optional<Bytes> open_box(const BoxKeys& receiver, std::string_view context, ByteView box) {
  prepare_sodium();
  PublicKey sender{};
  if (box.size() < sender.size() + crypto_box_MACBYTES) return std::nullopt;
  std::copy_n(box.begin(), sender.size(), sender.begin());
  const BoxNonce nonce = nonce_of(sender, receiver.public_half, context);
  const ByteView sealed = box.subspan(sender.size());
  Bytes plaintext(sealed.size() - crypto_box_MACBYTES);
  const int status = crypto_box_open_easy(plaintext.data(), sealed.data(), sealed.size(),
                                          nonce.data(), sender.data(), receiver.secret_half.data());
  if (status != 0) return std::nullopt;
  return plaintext;
}

Signer::Signer(const SecretKey& seed) {
  prepare_sodium();
  crypto_sign_seed_keypair(public_half_.data(), secret_half_.data(), seed.data());
}

Signature Signer::sign(ByteView message) const {
  Signature signature{};
  crypto_sign_detached(signature.data(), nullptr, message.data(), message.size(),
                       secret_half_.data());
  return signature;
}

Bytes station_statement(std::string_view study_id, std::string_view name,
                        const PublicKey& station) {
  const Digest statement =
      FieldHasher().add("touchtrial station 1").add(study_id).add(name).add(station).finish();
  return {statement.begin(), statement.end()};
}

bool is_signed_by(const PublicKey& signer, ByteView message, ByteView signature) {
  prepare_sodium();
  return signature.size() == crypto_sign_BYTES &&
         crypto_sign_verify_detached(signature.data(), message.data(), message.size(),
                                     signer.data()) == 0;
}

}  // namespace touchtrial
