#include "core/cipher.hpp"
#include "core/hash.hpp"
#include "support/catch.hpp"

#include <set>

using namespace touchtrial;

TEST_CASE("sha256 agrees with the standard's examples") {
  CHECK(to_hex(blake2b(bytes_of("abc"))) ==
        "bddd813c634239723171ef3fee98579b94964e3bb1cb3e427262c8c068d52319");
  CHECK(to_hex(sha256(bytes_of("abc"))) ==
        "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(to_hex(sha256(bytes_of(""))) ==
        "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST_CASE("the same bytes split into other fields give another digest") {
  CHECK(FieldHasher().add("ab").add("c").finish() != FieldHasher().add("a").add("bc").finish());
  CHECK(FieldHasher().add("ab").finish() != FieldHasher().add("ab").add("").finish());
  CHECK(FieldHasher().add(std::int64_t{-1}).finish() !=
        FieldHasher().add(std::int64_t{1}).finish());
}

TEST_CASE("a sealed text opens with its key and context and with no other") {
  const SecretKey key = SeededEntropy(1).secret("a");
  const SecretKey other = SeededEntropy(1).secret("b");
  const Bytes box = seal(key, "event|1|2", bytes_of("bark"));
  CHECK(unseal(key, "event|1|2", box) == Bytes{'b', 'a', 'r', 'k'});
  CHECK_FALSE(unseal(other, "event|1|2", box));
  CHECK_FALSE(unseal(key, "event|1|3", box));
}

TEST_CASE("a sealed text with any byte altered or missing does not open") {
  const SecretKey key = SeededEntropy(1).secret("a");
  const Bytes box = seal(key, "c", bytes_of("text"), 16);
  for (std::size_t i = 0; i < box.size(); ++i) {
    Bytes altered = box;
    altered[i] ^= 1U;
    CHECK_FALSE(unseal(key, "c", altered, 16));
    CHECK_FALSE(unseal(key, "c", ByteView(box).first(i), 16));
  }
}

TEST_CASE("sealed texts of any length under the padding have the same length") {
  const SecretKey key = SeededEntropy(1).secret("a");
  std::set<std::size_t> sizes;
  for (std::size_t length = 0; length < 64; ++length) {
    const std::string text(length, '\x80');
    const Bytes box = seal(key, "c", bytes_of(text), 64);
    CHECK(unseal(key, "c", box, 64) == Bytes(text.begin(), text.end()));
    sizes.insert(box.size());
  }
  CHECK(sizes.size() == 1);
  CHECK(seal(key, "c", Bytes(64), 64).size() > *sizes.begin());
}

TEST_CASE("equal texts in different contexts are sealed to unlike bytes") {
  const SecretKey key = SeededEntropy(1).secret("a");
  const Bytes first = seal(key, "trial 1", bytes_of("bark"));
  const Bytes second = seal(key, "trial 2", bytes_of("bark"));
  std::size_t equal = 0;
  for (std::size_t i = 0; i < first.size(); ++i) equal += first[i] == second[i] ? 1U : 0U;
  CHECK(first.size() == second.size());
  CHECK(equal < first.size() / 16);
}

TEST_CASE("the system's secrets differ, and a seeded one depends on seed and purpose alone") {
  SystemEntropy system;
  CHECK(system.secret("a") != system.secret("a"));
  CHECK(SeededEntropy(7).secret("a") == SeededEntropy(7).secret("a"));
  CHECK(SeededEntropy(7).secret("a") != SeededEntropy(8).secret("a"));
  CHECK(SeededEntropy(7).secret("a") != SeededEntropy(7).secret("b"));
}
