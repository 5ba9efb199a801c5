#include "core/random.hpp"

#include "support/catch.hpp"

#include <array>
#include <cmath>
#include <map>

using namespace touchtrial;

TEST_CASE("seed, purpose and index determine a stream's numbers for ever") {
  RandomStream random(31875542, "schedule", 1);
  const std::array<std::uint64_t, 3> first = {random.bits(), random.bits(), random.bits()};
  CHECK(first == std::array<std::uint64_t, 3>{3579677490342817192ULL, 5722241296468689785ULL,
                                              6556397578880777809ULL});
}

TEST_CASE("another seed, purpose or index gives another stream") {
  const std::uint64_t base = RandomStream(1, "a", 0).bits();
  CHECK(RandomStream(1, "a", 0).bits() == base);
  CHECK(RandomStream(2, "a", 0).bits() != base);
  CHECK(RandomStream(1, "b", 0).bits() != base);
  CHECK(RandomStream(1, "a", 1).bits() != base);
}

TEST_CASE("whole numbers below a bound stay below it and are equally likely") {
  RandomStream random(5, "test");
  CHECK(random.below(1) == 0);
  constexpr int kDraws = 60000;
  std::array<int, 6> counts{};
  for (int i = 0; i < kDraws; ++i) ++counts.at(static_cast<std::size_t>(random.below(6)));
  double chi_square = 0.0;
  for (const int count : counts) chi_square += std::pow(count - kDraws / 6.0, 2) / (kDraws / 6.0);
  CHECK(chi_square < 25.74);  // 99.99 % of the chi-square distribution with 5 degrees of freedom
  const std::uint64_t huge = (std::uint64_t{1} << 63U) + 1;
  for (int i = 0; i < 100; ++i) CHECK(random.below(huge) < huge);
}

TEST_CASE("a shuffle gives each order equally often and loses nothing") {
  RandomStream random(9, "test");
  constexpr int kDraws = 24000;
  std::map<std::array<int, 4>, int> counts;
  for (int i = 0; i < kDraws; ++i) {
    std::array<int, 4> cards = {0, 1, 2, 3};
    shuffle<int>(cards, random);
    ++counts[cards];
  }
  REQUIRE(counts.size() == 24);
  double chi_square = 0.0;
  for (const auto& [order, count] : counts) chi_square += std::pow(count - 1000.0, 2) / 1000.0;
  CHECK(chi_square < 57.1);  // 99.99 % with 23 degrees of freedom
}

TEST_CASE("uniform and normal numbers have the moments of their distributions") {
  RandomStream random(3, "test");
  constexpr int kDraws = 100000;
  double uniform_sum = 0.0;
  double normal_sum = 0.0;
  double square_sum = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double u = random.uniform();
    REQUIRE((u >= 0.0 && u < 1.0));
    uniform_sum += u;
    const double z = random.normal();
    normal_sum += z;
    square_sum += z * z;
  }
  // Four standard errors each.
  CHECK(std::abs(uniform_sum / kDraws - 0.5) < 4 * std::sqrt(1.0 / 12 / kDraws));
  CHECK(std::abs(normal_sum / kDraws) < 4 * std::sqrt(1.0 / kDraws));
  CHECK(std::abs(square_sum / kDraws - 1.0) < 4 * std::sqrt(2.0 / kDraws));
}
