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

TEST_CASE("symmetric_index of a single sample is always that sample") {
  for (int i = -20; i <= 20; ++i) CHECK(engine::symmetric_index(i, 1) == 0);
}

TEST_CASE("symmetric_index agrees with its definition however far outside") {
  for (const int n : {1, 2, 3, 5, 8, 63}) {
    for (int i = -300; i <= 300; ++i) {
      INFO("i " << i << ", n " << n);
      REQUIRE(engine::symmetric_index(i, n) == reference::mirrored(i, n));
    }
  }
}

TEST_CASE("mirror_ends continues a row on both sides, even beyond its length") {
  for (const int width : {1, 2, 5}) {
    constexpr int kMargin = 7;
    std::vector<int> row(static_cast<std::size_t>(width) + 2 * kMargin, -1);
    for (int i = 0; i < width; ++i) row[static_cast<std::size_t>(kMargin + i)] = i;
    engine::mirror_ends(row.data() + kMargin, width, kMargin);
    for (int i = -kMargin; i < width + kMargin; ++i) {
      CHECK(row[static_cast<std::size_t>(kMargin + i)] == reference::mirrored(i, width));
    }
  }
}

}  // namespace
}  // namespace touchtrial
