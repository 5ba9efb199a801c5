#include "core/passphrase.hpp"

#include "support/catch.hpp"

#include <numeric>
#include <stdexcept>

namespace touchtrial {
namespace {

constexpr PassphraseCost kSmall{2, std::uint64_t{64} << 10U};

Salt counted_salt() {
  Salt salt{};
  std::iota(salt.begin(), salt.end(), std::uint8_t{0});
  return salt;
}

}  // namespace

TEST_CASE("a passphrase gives the key that another implementation of Argon2id gives") {
  // libargon2: argon2id_hash_raw(2, 64, 1, passphrase, 21, salt, 16, key, 32)
  CHECK(to_hex(key_of_passphrase("correct horse battery", counted_salt(), kSmall)) ==
        "8b43092dd6040f5014c8c8fdc04f1e15a8057ef0595f6cd2d61193c9b691cc8c");
}

TEST_CASE("passphrase, salt and cost all decide the key") {
  const SecretKey key = key_of_passphrase("one passphrase", counted_salt(), kSmall);
  Salt other_salt = counted_salt();
  other_salt.back() ^= 1U;
  CHECK(key_of_passphrase("one passphrase", counted_salt(), kSmall) == key);
  CHECK(key_of_passphrase("one passphrasf", counted_salt(), kSmall) != key);
  CHECK(key_of_passphrase("one passphrase", other_salt, kSmall) != key);
  CHECK(key_of_passphrase("one passphrase", counted_salt(), {3, kSmall.memory_bytes}) != key);
  CHECK(key_of_passphrase("one passphrase", counted_salt(), {2, 2 * kSmall.memory_bytes}) != key);
}

TEST_CASE("a cost out of range is refused") {
  const PassphraseCost& least = kMinPassphraseCost;
  const PassphraseCost& most = kMaxPassphraseCost;
  for (const PassphraseCost& cost :
       {PassphraseCost{0, kSmall.memory_bytes},
        PassphraseCost{most.passes + 1, kSmall.memory_bytes},
        PassphraseCost{1, least.memory_bytes - 1}, PassphraseCost{1, most.memory_bytes + 1}}) {
    CHECK_THROWS_AS(key_of_passphrase("passphrase", counted_salt(), cost), std::invalid_argument);
  }
}

}  // namespace touchtrial
