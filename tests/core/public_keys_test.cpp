#include "core/public_keys.hpp"

#include "support/catch.hpp"

namespace touchtrial {
namespace {

SecretKey seed_of(std::uint64_t number) {
  return SeededEntropy(number).secret("test");
}

}  // namespace

TEST_CASE("a box opens for its receiver alone, in its own context") {
  const BoxKeys receiver = box_keys(seed_of(1));
  const Bytes message = {1, 2, 3, 4, 5};
  const Bytes box = seal_box(receiver.public_half, "session 1", message, seed_of(2));
  CHECK(box.size() == message.size() + 48);
  CHECK(open_box(receiver, "session 1", box) == message);
  CHECK_FALSE(open_box(receiver, "session 2", box));
  CHECK_FALSE(open_box(box_keys(seed_of(3)), "session 1", box));
  CHECK_FALSE(open_box(receiver, "session 1", ByteView(box).first(47)));
  for (std::size_t i = 0; i < box.size(); ++i) {
    Bytes altered = box;
    altered[i] ^= 1U;
    CHECK_FALSE(open_box(receiver, "session 1", altered));
  }
  CHECK(open_box(receiver, "", seal_box(receiver.public_half, "", {}, seed_of(2))) == Bytes{});
}

TEST_CASE("the sealer cannot open the box again") {
  const BoxKeys receiver = box_keys(seed_of(1));
  const BoxKeys sender = box_keys(seed_of(2));
  const Bytes box = seal_box(receiver.public_half, "", bytes_of("secret"), seed_of(2));
  CHECK_FALSE(open_box(sender, "", box));
}

TEST_CASE("a key that is no point of the curve is refused") {
  CHECK_THROWS_AS(seal_box(PublicKey{}, "", {}, seed_of(2)), std::invalid_argument);
}

TEST_CASE("signatures are those of RFC 8032, and hold for one message and one signer") {
  // RFC 8032, section 7.1, test 2.
  const SecretKey seed =
      digest_from_hex("4ccd089b28ff96da9db6c346ec114e0f5b8a319f35aba624da8cf6ed4fb8a6fb").value();
  const Signer signer(seed);
  CHECK(to_hex(signer.public_half()) ==
        "3d4017c3e843895a92b70aa74d1b7ebc9c982ccf2ec4968cc0cd55f12af4660c");
  const Bytes message = {0x72};
  const Signature signature = signer.sign(message);
  CHECK(to_hex(ByteView(signature)) ==
        "92a009a9f0d4cab8720e820b5f642540a2b27b5416503f8fb3762223ebdb69da"
        "085ac1e43e15996e458f3613d0f11d8c387b2eaeb4302aeeb00d291612bb0c00");
  CHECK(is_signed_by(signer.public_half(), message, signature));
  CHECK_FALSE(is_signed_by(signer.public_half(), Bytes{0x73}, signature));
  CHECK_FALSE(is_signed_by(Signer(seed_of(1)).public_half(), message, signature));
  CHECK_FALSE(is_signed_by(signer.public_half(), message, ByteView(signature).first(63)));
}

}  // namespace touchtrial
