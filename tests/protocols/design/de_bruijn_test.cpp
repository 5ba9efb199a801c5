#include "protocols/design/de_bruijn.hpp"

#include "protocols/design/order_test_support.hpp"
#include "support/catch.hpp"

#include <map>
#include <set>
#include <utility>

namespace touchtrial {

TEST_CASE("every ordered pair of symbols follows each other once in a de Bruijn cycle") {
  RandomStream random(1, "test");
  for (int symbols = 1; symbols <= 12; ++symbols) {
    for (int repetition = 0; repetition < 20; ++repetition) {
      const std::vector<int> cycle = design::random_de_bruijn_cycle(symbols, random);
      REQUIRE(cycle.size() == static_cast<std::size_t>(symbols) * symbols);
      std::set<std::pair<int, int>> pairs;
      for (std::size_t i = 0; i < cycle.size(); ++i) {
        pairs.emplace(cycle[i], cycle[(i + 1) % cycle.size()]);
      }
      CHECK(pairs.size() == cycle.size());
      CHECK(*pairs.begin() == std::pair(0, 0));
      CHECK(*pairs.rbegin() == std::pair(symbols - 1, symbols - 1));
    }
  }
}

TEST_CASE("each of the 216 de Bruijn sequences over three symbols is equally likely") {
  // (3!)^3 / 3^2 = 24 cycles, each with 9 starts. 99.9999 % of chi-square with 215 degrees of
  // freedom lie below 332.
  RandomStream random(2, "test");
  std::map<std::vector<int>, int> counts;
  for (int i = 0; i < 216 * 100; ++i) ++counts[design::random_de_bruijn_cycle(3, random)];
  CHECK(counts.size() == 216);
  CHECK(chi_square_uniform(counts, 216) < 332.0);
}

}  // namespace touchtrial
