#include "core/passphrase.hpp"

#include "core/sodium.hpp"

#include <new>
#include <stdexcept>

#include <sodium.h>

namespace touchtrial {

bool is_in_range(const PassphraseCost& cost) noexcept {
  const PassphraseCost& min = kMinPassphraseCost;
  const PassphraseCost& max = kMaxPassphraseCost;
  return cost.passes >= min.passes && cost.passes <= max.passes &&
         cost.memory_bytes >= min.memory_bytes && cost.memory_bytes <= max.memory_bytes;
}

SecretKey key_of_passphrase(std::string_view passphrase, const Salt& salt,
                            const PassphraseCost& cost) {
  static_assert(std::tuple_size_v<Salt> == crypto_pwhash_SALTBYTES);
  if (!is_in_range(cost)) {
    throw std::invalid_argument("key_of_passphrase: the cost is out of range");
  }
  if (!prepare_sodium()) throw std::runtime_error("libsodium cannot be used");
  SecretKey key{};
  const int status =
      crypto_pwhash(key.data(), key.size(), passphrase.data(), passphrase.size(), salt.data(),
                    cost.passes, cost.memory_bytes, crypto_pwhash_ALG_ARGON2ID13);
  if (status != 0) throw std::bad_alloc();
  return key;
}

}  // namespace touchtrial
