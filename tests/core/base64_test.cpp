#include "core/base64.hpp"

#include "support/catch.hpp"

using namespace touchtrial;

TEST_CASE("base64 of the examples in RFC 4648") {
  CHECK(to_base64({}).empty());
  CHECK(to_base64(bytes_of("f")) == "Zg==");
  CHECK(to_base64(bytes_of("fo")) == "Zm8=");
  CHECK(to_base64(bytes_of("foobar")) == "Zm9vYmFy");
  const Bytes high = {0xfb, 0xff};
  CHECK(to_base64(high) == "+/8=");
}
