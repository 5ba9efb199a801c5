#include "study/random_orders.hpp"

#include "study/order_test_support.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

namespace touchtrial {
namespace {

bool keeps(const std::vector<int>& order, int max_run, study::PrecedingRun before) {
  return std::ranges::all_of(order, [&](int symbol) {
    before = study::run_at_end({symbol}, before);
    return before.length <= max_run;
  });
}

/// Every order of the copies, by trying all.
std::set<std::vector<int>> allowed(const std::vector<int>& counts, int max_run,
                                   study::PrecedingRun before) {
  std::vector<int> order;
  for (int s = 0; s < static_cast<int>(counts.size()); ++s) {
    order.insert(order.end(), static_cast<std::size_t>(counts[static_cast<std::size_t>(s)]), s);
  }
  std::set<std::vector<int>> found;
  do {
    if (keeps(order, max_run, before)) found.insert(order);
  } while (std::ranges::next_permutation(order).found);
  return found;
}

/// Every sequence of that length, by trying all.
std::set<std::vector<int>> allowed_sequences(int symbols, int length, int max_run,
                                             study::PrecedingRun before) {
  std::set<std::vector<int>> found = {{}};
  for (int i = 0; i < length; ++i) {
    std::set<std::vector<int>> longer;
    for (const std::vector<int>& sequence : found) {
      for (int symbol = 0; symbol < symbols; ++symbol) {
        longer.insert(sequence);
        std::vector<int> next = sequence;
        next.push_back(symbol);
        if (keeps(next, max_run, before)) longer.insert(next);
      }
      longer.erase(sequence);
    }
    found = longer;
  }
  return found;
}

struct Case {
  std::vector<int> counts;
  int max_run;
  study::PrecedingRun before;
};

std::vector<Case> small_cases() {
  std::vector<Case> cases;
  const std::vector<std::vector<int>> multisets = {
      {2, 2},    {3, 3},    {1, 4},    {0, 2},    {5, 1},       {2, 2, 2},    {3, 1, 1},
      {4, 1, 1}, {6, 1, 1}, {1, 2, 3}, {3, 3, 2}, {1, 1, 1, 1}, {2, 2, 2, 1}, {0, 0, 3}};
  for (const auto& counts : multisets) {
    for (int max_run = 1; max_run <= 3; ++max_run) {
      cases.push_back({counts, max_run, {}});
      for (int length = 1; length <= max_run; ++length) {
        cases.push_back({counts, max_run, {0, length}});
        cases.push_back({counts, max_run, {static_cast<int>(counts.size()) - 1, length}});
      }
    }
  }
  return cases;
}

/// Draws often, and compares the frequencies with equal ones.
/// \return the statistic's excess over its mean, in standard deviations
template <typename Draw>
double excess(const std::set<std::vector<int>>& possible, int draws_each, const Draw& draw) {
  std::map<std::vector<int>, int> counts;
  const int draws = draws_each * static_cast<int>(possible.size());
  for (int i = 0; i < draws; ++i) ++counts[draw(i)];
  for (const auto& [order, count] : counts) REQUIRE(possible.count(order) == 1);
  const double freedom = static_cast<double>(possible.size()) - 1.0;
  const double statistic = chi_square_uniform(counts, static_cast<int>(possible.size()));
  return (statistic - freedom) / std::sqrt(2.0 * std::max(freedom, 1.0));
}

}  // namespace

TEST_CASE("orders with limited runs are drawn from all, and found impossible where they are") {
  int impossible = 0;
  for (const auto& [counts, max_run, before] : small_cases()) {
    const auto possible = allowed(counts, max_run, before);
    INFO("limit " << max_run << " after " << before.length << " of " << before.symbol);
    CHECK(study::limited_order_exists(counts, max_run, before) == !possible.empty());
    RandomStream random(1, "test");
    const auto drawn = study::draw_limited_order(counts, max_run, before, random);
    CHECK(drawn.has_value() == !possible.empty());
    if (drawn) CHECK(possible.count(*drawn) == 1);
    impossible += possible.empty() ? 1 : 0;
  }
  CHECK(impossible > 20);
}

TEST_CASE("orders with limited runs are drawn uniformly from all") {
  const std::vector<Case> cases = {
      {{2, 2, 2}, 1, {}},     {{3, 3}, 2, {}},        {{3, 2, 1}, 2, {}},
      {{2, 2, 2}, 1, {1, 1}}, {{3, 3, 1}, 2, {0, 1}}, {{2, 1, 1, 1}, 1, {}},
      {{4, 1, 1}, 2, {}},     {{1, 2, 3}, 3, {2, 1}}, {{2, 2, 2, 1}, 2, {3, 2}},
      {{3, 3, 2}, 3, {}},     {{5, 2}, 3, {0, 1}},    {{0, 2, 2}, 1, {0, 1}}};
  for (const auto& [counts, max_run, before] : cases) {
    RandomStream random(7, "uniform test");
    const auto possible = allowed(counts, max_run, before);
    REQUIRE(possible.size() > 1);
    CHECK(std::abs(excess(possible, 200, [&](int) {
            return study::draw_limited_order(counts, max_run, before, random).value();
          })) < 4.0);
  }
}

TEST_CASE("sequences with limited runs are drawn uniformly from all") {
  const std::vector<Case> cases = {
      {{2}, 1, {}}, {{2}, 2, {}}, {{3}, 2, {1, 1}}, {{3}, 1, {2, 1}}, {{2}, 3, {0, 3}}};
  for (const auto& [symbols, max_run, before] : cases) {
    RandomStream random(8, "uniform test");
    const auto possible = allowed_sequences(symbols.front(), 5, max_run, before);
    REQUIRE_FALSE(possible.empty());
    CHECK(std::abs(excess(possible, 300, [&](int) {
            return study::draw_limited_sequence(symbols.front(), 5, max_run, before, random);
          })) < (possible.size() > 1 ? 4.0 : 1.1));
  }
}

TEST_CASE("Williams orders with and without a limit are drawn uniformly from all that there are") {
  struct WilliamsCase {
    int symbols, rows, max_run;
    study::PrecedingRun before;
  };
  for (const auto& [symbols, rows, max_run, before] : std::vector<WilliamsCase>{
           {3, 2, 0, {}}, {3, 3, 1, {}}, {4, 2, 1, {}}, {3, 4, 1, {2, 1}}, {2, 3, 2, {0, 2}}}) {
    RandomStream free_random(9, "all");
    std::set<std::vector<int>> possible;
    for (int i = 0; i < 20'000; ++i) {
      const auto order = study::random_williams_order(symbols, rows, 0, {}, free_random);
      if (max_run == 0 || keeps(order, max_run, before)) possible.insert(order);
    }
    RandomStream random(10, "limited");
    INFO(symbols << " symbols, " << rows << " rows, limit " << max_run);
    CHECK(std::abs(excess(possible, 100, [&](int) {
            return study::random_williams_order(symbols, rows, max_run, before, random);
          })) < 4.0);
  }
}

TEST_CASE("two rows of two symbols are the one Williams order that no limit of 1 allows") {
  CHECK_FALSE(study::williams_order_exists(2, 2, 1));
  RandomStream random(11, "two");
  for (int i = 0; i < 100; ++i) {
    CHECK_FALSE(keeps(study::random_williams_order(2, 2, 0, {}, random), 1, {}));
  }
  CHECK(study::williams_order_exists(2, 1, 1));
  for (int symbols = 3; symbols < 9; ++symbols) {
    CHECK(study::williams_order_exists(symbols, 50, 1));
    CHECK(keeps(study::random_williams_order(symbols, 50, 1, {}, random), 1, {}));
  }
}

TEST_CASE("all rows of a Williams order balance places and, within rows, neighbours") {
  for (const int symbols : {3, 4, 5, 6}) {
    RandomStream random(12, "balance");
    const int rows = symbols % 2 == 0 ? symbols : 2 * symbols;
    const auto order = study::random_williams_order(symbols, rows, 0, {}, random);
    std::map<std::pair<int, int>, int> places;
    std::map<std::pair<int, int>, int> neighbours;
    for (int i = 0; i < rows * symbols; ++i) {
      const int place = i % symbols;
      const int symbol = order[static_cast<std::size_t>(i)];
      ++places[{place, symbol}];
      if (place > 0) ++neighbours[{order[static_cast<std::size_t>(i) - 1], symbol}];
    }
    for (const auto& [where, count] : places) CHECK(count == rows / symbols);
    CHECK(neighbours.size() == static_cast<std::size_t>(symbols * (symbols - 1)));
    for (const auto& [pair, count] : neighbours) CHECK(count == rows / symbols);
  }
}

TEST_CASE("sizes too large to count are reported before anything is counted") {
  CHECK(study::limited_orders_are_countable(std::vector<int>(5, 5), 2));
  CHECK(study::limited_orders_are_countable(std::vector<int>(2, 300), 2));
  CHECK(study::limited_orders_are_countable(std::vector<int>(12, 5), 2));
  CHECK(study::limited_orders_are_countable(std::vector<int>(64, 2), 2));
  CHECK_FALSE(study::limited_orders_are_countable(std::vector<int>(64, 156), 2));
  CHECK_FALSE(study::limited_orders_are_countable(std::vector<int>(2, 5000), 2));
  CHECK_FALSE(study::limited_orders_are_countable(std::vector<int>(32, 5), 2));
  CHECK_FALSE(study::limited_orders_are_countable(std::vector<int>(2, 300), 100));
}

TEST_CASE("the largest sizes are drawn") {
  RandomStream random(13, "large");
  for (const auto& [symbols, copies, max_run] :
       {std::tuple{2, 300, 3}, {12, 5, 1}, {64, 2, 1}, {5, 12, 2}}) {
    const std::vector<int> counts(static_cast<std::size_t>(symbols), copies);
    const auto order = study::draw_limited_order(counts, max_run, {}, random).value();
    CHECK(keeps(order, max_run, {}));
    for (int s = 0; s < symbols; ++s) CHECK(std::ranges::count(order, s) == copies);
  }
  CHECK(keeps(study::draw_limited_sequence(2, 10'000, 2, {}, random), 2, {}));
  CHECK(study::draw_limited_sequence(64, 10'000, 9'000, {}, random).size() == 10'000);
}

TEST_CASE("every ordered pair of symbols follows each other once in a de Bruijn cycle") {
  RandomStream random(1, "test");
  for (int symbols = 1; symbols <= 12; ++symbols) {
    for (int repetition = 0; repetition < 20; ++repetition) {
      const std::vector<int> cycle = study::random_de_bruijn_cycle(symbols, random);
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
  for (int i = 0; i < 216 * 100; ++i) ++counts[study::random_de_bruijn_cycle(3, random)];
  CHECK(counts.size() == 216);
  CHECK(chi_square_uniform(counts, 216) < 332.0);
}

}  // namespace touchtrial
