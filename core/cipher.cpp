#include "core/cipher.hpp"

#include "core/sodium.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include <sodium.h>

namespace touchtrial {
namespace {

constexpr std::size_t kNonceSize = crypto_aead_xchacha20poly1305_ietf_NPUBBYTES;
constexpr std::size_t kTagSize = crypto_aead_xchacha20poly1305_ietf_ABYTES;

std::size_t padded_length(std::size_t size, std::size_t multiple) {
  if (multiple == 0) throw std::invalid_argument("seal: padded_size must be at least 1");
  return (size / multiple + 1) * multiple;
}

std::optional<Bytes> without_padding(Bytes bytes) {
  const auto mark = std::find_if(bytes.rbegin(), bytes.rend(), [](auto byte) { return byte != 0; });
  if (mark == bytes.rend() || *mark != 0x80) return std::nullopt;
  bytes.erase(std::prev(mark.base()), bytes.end());
  return bytes;
}

std::array<std::uint8_t, kNonceSize> synthetic_nonce(const SecretKey& key, std::string_view context,
                                                     ByteView plaintext) {
  prepare_sodium();
  crypto_generichash_state state;
  crypto_generichash_init(&state, key.data(), key.size(), kNonceSize);
  const Digest context_hash = sha256(bytes_of(context));
  crypto_generichash_update(&state, context_hash.data(), context_hash.size());
  crypto_generichash_update(&state, plaintext.data(), plaintext.size());
  std::array<std::uint8_t, kNonceSize> nonce{};
  crypto_generichash_final(&state, nonce.data(), nonce.size());
  return nonce;
}

}  // namespace

Bytes seal(const SecretKey& key, std::string_view context, ByteView plaintext,
           std::size_t padded_size) {
  const std::size_t size = padded_length(plaintext.size(), padded_size);
  const auto nonce = synthetic_nonce(derive_key(key, "nonce"), context, plaintext);
  const SecretKey cipher_key = derive_key(key, "cipher");
  Bytes box(kNonceSize + size + kTagSize);
  std::copy(nonce.begin(), nonce.end(), box.begin());
  // The text is encrypted in place. Padding is one mark byte, then zeros (ISO/IEC 7816-4), so that
  // it can be removed unambiguously.
  std::uint8_t* const text = box.data() + kNonceSize;
  std::copy(plaintext.begin(), plaintext.end(), text);
  text[plaintext.size()] = 0x80;
  const ByteView context_bytes = bytes_of(context);
  crypto_aead_xchacha20poly1305_ietf_encrypt(text, nullptr, text, size, context_bytes.data(),
                                             context_bytes.size(), nullptr, nonce.data(),
                                             cipher_key.data());
  return box;
}

std::optional<Bytes> unseal(const SecretKey& key, std::string_view context, ByteView box,
                            std::size_t padded_size) {
  return Unsealer(key)(context, box, padded_size);
}

Unsealer::Unsealer(const SecretKey& key) : cipher_key_(derive_key(key, "cipher")) {}

std::optional<Bytes> Unsealer::operator()(std::string_view context, ByteView box,
                                          std::size_t padded_size) const {
  if (padded_size == 0) throw std::invalid_argument("unseal: padded_size must be at least 1");
  if (box.size() < kNonceSize + kTagSize) return std::nullopt;
  Bytes text(box.size() - kNonceSize - kTagSize);
  if (text.size() % padded_size != 0) return std::nullopt;
  prepare_sodium();
  const ByteView context_bytes = bytes_of(context);
  const int status = crypto_aead_xchacha20poly1305_ietf_decrypt(
      text.data(), nullptr, nullptr, box.data() + kNonceSize, box.size() - kNonceSize,
      context_bytes.data(), context_bytes.size(), box.data(), cipher_key_.data());
  if (status != 0) return std::nullopt;
  return without_padding(std::move(text));
}

SecretKey derive_key(const SecretKey& key, std::string_view purpose) {
  return keyed_hash(key, bytes_of(purpose));
}

SecretKey SystemEntropy::secret(std::string_view /*purpose*/) {
  if (!prepare_sodium()) throw std::runtime_error("the system's random generator is not available");
  SecretKey bytes{};
  randombytes_buf(bytes.data(), bytes.size());
  return bytes;
}

SecretKey SeededEntropy::secret(std::string_view purpose) {
  return FieldHasher()
      .add("touchtrial seeded entropy")
      .add(static_cast<std::int64_t>(seed_))
      .add(purpose)
      .finish();
}

}  // namespace touchtrial
