#include "core/bytes.hpp"

#include "core/hash.hpp"
#include "support/catch.hpp"

using namespace touchtrial;

TEST_CASE("hexadecimal round-trips, and anything else is refused") {
  const Bytes bytes{0x00, 0x7f, 0xff};
  CHECK(to_hex(bytes) == "007fff");
  CHECK(from_hex("007fff") == bytes);
  CHECK_FALSE(from_hex("0"));
  CHECK_FALSE(from_hex("0g"));
  CHECK_FALSE(from_hex("00 1"));
  CHECK_FALSE(digest_from_hex("00"));
  CHECK(digest_from_hex(to_hex(sha256(bytes_of("x")))) == sha256(bytes_of("x")));
}

TEST_CASE("base64 agrees with the examples in RFC 4648") {
  CHECK(to_base64({}).empty());
  CHECK(to_base64(bytes_of("f")) == "Zg==");
  CHECK(to_base64(bytes_of("fo")) == "Zm8=");
  CHECK(to_base64(bytes_of("foobar")) == "Zm9vYmFy");
  const Bytes high = {0xfb, 0xff};
  CHECK(to_base64(high) == "+/8=");
}
