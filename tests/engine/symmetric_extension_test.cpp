#include "engine/symmetric_extension.hpp"

#include "engine/reference/mirror.hpp"
#include "support/catch.hpp"

#include <vector>

namespace touchtrial {
namespace {

TEST_CASE("symmetric_index repeats the edge samples") {
  std::vector<int> indices;
  for (int i = -4; i < 7; ++i) indices.push_back(engine::symmetric_index(i, 3));
  CHECK(indices == std::vector<int>{2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0});
}

TEST_CASE("symmetric_index knows one sample only when there is one") {
  for (int i = -20; i <= 20; ++i) CHECK(engine::symmetric_index(i, 1) == 0);
}

TEST_CASE("symmetric_index follows its definition however far outside") {
  for (const int n : {1, 2, 3, 5, 8, 63}) {
    for (int i = -300; i <= 300; ++i) {
      INFO("i " << i << ", n " << n);
      REQUIRE(engine::symmetric_index(i, n) == reference::mirrored(i, n));
    }
  }
}

}  // namespace
}  // namespace touchtrial
