#include "analysis/statistics/chance_test.hpp"

#include "core/random.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace touchtrial {
namespace {

using namespace analysis;
using Answers = std::vector<std::optional<int>>;

int right_in(const std::vector<int>& presented, const Answers& answered) {
  int right = 0;
  for (std::size_t i = 0; i < presented.size(); ++i) right += answered[i] == presented[i] ? 1 : 0;
  return right;
}

/// The distribution over every order of the presentations, all listed.
std::vector<double> by_listing(std::vector<int> presented, const Answers& answered) {
  std::sort(presented.begin(), presented.end());
  std::vector<double> probability(presented.size() + 1);
  double orders = 0.0;
  do {
    ++probability[right_in(presented, answered)];
    ++orders;
  } while (std::next_permutation(presented.begin(), presented.end()));
  for (double& p : probability) p /= orders;
  return probability;
}

std::vector<double> convolved(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> sum(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) sum[i + j] += a[i] * b[j];
  }
  return sum;
}

double tail(const std::vector<double>& probability, int from) {
  return std::accumulate(probability.begin() + from, probability.end(), 0.0);
}

AnsweredBlock random_block(int classes, int trials, RandomStream& random) {
  AnsweredBlock block;
  for (int i = 0; i < trials; ++i) {
    block.presented.push_back(static_cast<int>(random.below(classes)));
    const auto answer = static_cast<int>(random.below(classes + 1));
    block.answered.push_back(answer == classes ? std::nullopt : std::optional(answer));
  }
  return block;
}

/// Five classes five times each in a random order.
std::vector<int> balanced_25(RandomStream& random) {
  std::vector<int> order;
  for (int i = 0; i < 25; ++i) order.push_back(i / 5);
  shuffle(std::span(order), random);
  return order;
}

/// The answers of a participant who feels nothing, but is told after each trial what was presented,
/// and answers the class that must be left most often.
Answers card_counter(const std::vector<int>& presented) {
  std::vector<int> left(5, 5);
  Answers answers;
  for (const int shown : presented) {
    answers.push_back(static_cast<int>(std::max_element(left.begin(), left.end()) - left.begin()));
    --left[shown];
  }
  return answers;
}

AnsweredBlock with_right(int right) {
  AnsweredBlock block;
  for (int i = 0; i < 25; ++i) {
    block.presented.push_back(i / 5);
    block.answered.push_back(i < right ? i / 5 : (i / 5 + 1) % 5);
  }
  return block;
}

TEST_CASE(
    "what chance_test can reach is the largest p within its level that the answers can have") {
  for (const OrderRule order : {OrderRule::permuted, OrderRule::independent}) {
    // Every order of the presentations under the same answers: every number of right answers.
    AnsweredBlock block{{0, 0, 0, 1, 1, 1, 2, 2}, {0, 0, 1, 1, 2, 2, 0, 1}};
    const double said = analysis::chance_test(3, std::vector{block}, order)->attainable;
    double largest = 0.0;
    do {
      const ChanceTest test = *analysis::chance_test(3, std::vector{block}, order);
      if (test.p <= kSignificanceLevel) largest = std::max(largest, test.p);
      CHECK(test.attainable == said);
    } while (std::next_permutation(block.presented.begin(), block.presented.end()));
    CHECK(largest > 0.0);
    CHECK(said == Approx(largest).epsilon(1e-12));
  }
}

}  // namespace

TEST_CASE("Independent presentations need 9 right of 25 at chance 1/5") {
  const std::vector<AnsweredBlock> nine{with_right(9)};
  const ChanceTest test = *analysis::chance_test(5, nine, OrderRule::independent);
  CHECK(test.correct == 9);
  CHECK(test.trials == 25);
  CHECK(test.expected == Approx(5.0));
  CHECK(test.exact);
  // SciPy 1.10, binom.sf(8, 25, 0.2) and binom.sf(7, 25, 0.2).
  CHECK(test.p == Approx(0.04677424217777292).epsilon(1e-12));
  const std::vector<AnsweredBlock> eight{with_right(8)};
  CHECK(analysis::chance_test(5, eight, OrderRule::independent)->p ==
        Approx(0.10912279599503055).epsilon(1e-12));
}

// Expected values: the same polynomials in Python's exact fractions.
TEST_CASE("match_probabilities of five classes five times each are the exact ones") {
  const std::vector<double> evenly = analysis::match_probabilities(ClassCounts(5, {5, 5}), 25);
  CHECK(tail(evenly, 8) == Approx(0.11373753916446125).epsilon(1e-13));
  CHECK(tail(evenly, 9) == Approx(0.05042669371059771).epsilon(1e-13));
  CHECK(tail(evenly, 20) == Approx(8.732920800736625e-10).epsilon(1e-13));
  CHECK(tail(evenly, 25) == Approx(1.6042075331639573e-15).epsilon(1e-13));
  const std::vector<double> biased =
      analysis::match_probabilities({{5, 9}, {5, 7}, {5, 5}, {5, 3}, {5, 1}}, 25);
  CHECK(tail(biased, 8) == Approx(0.10436987985263173).epsilon(1e-13));
  CHECK(tail(biased, 15) == Approx(5.818412760188847e-06).epsilon(1e-13));
}

TEST_CASE("match_probabilities of distinct cards are those of fixed points") {
  // n objects once each: the probability of no match nears 1/e, of all n it is 1/n!.
  const std::vector<double> p = analysis::match_probabilities(ClassCounts(8, {1, 1}), 8);
  CHECK(p[0] == Approx(14833.0 / 40320.0).epsilon(1e-14));
  CHECK(p[7] == 0.0);
  CHECK(p[8] == Approx(1.0 / 40320.0).epsilon(1e-14));
}

TEST_CASE("match_probabilities of hundreds of trials sum to 1 with the right mean") {
  const ClassCounts counts{{60, 80}, {60, 20}, {100, 90}, {80, 100}};
  const std::vector<double> p = analysis::match_probabilities(counts, 300);
  double sum = 0.0;
  double mean = 0.0;
  for (std::size_t k = 0; k < p.size(); ++k) {
    REQUIRE(p[k] >= 0.0);
    sum += p[k];
    mean += static_cast<double>(k) * p[k];
  }
  CHECK(sum == Approx(1.0).epsilon(1e-12));
  CHECK(mean == Approx((60.0 * 80 + 60 * 20 + 100 * 90 + 80 * 100) / 300.0).epsilon(1e-12));
}

TEST_CASE("chance_test equals the listing of all orders, also with missing responses") {
  RandomStream random(4, "chance test test");
  for (int round = 0; round < 40; ++round) {
    const int classes = 2 + round % 4;
    const AnsweredBlock first = random_block(classes, 2 + round % 6, random);
    const AnsweredBlock second = random_block(classes, 1 + round % 5, random);
    const std::vector<AnsweredBlock> blocks{first, second};
    const ChanceTest test = *analysis::chance_test(classes, blocks, OrderRule::permuted);
    const std::vector<double> all = convolved(by_listing(first.presented, first.answered),
                                              by_listing(second.presented, second.answered));
    double mean = 0.0;
    for (std::size_t k = 0; k < all.size(); ++k) mean += static_cast<double>(k) * all[k];
    CHECK(test.exact);
    CHECK(test.p == Approx(tail(all, test.correct)).epsilon(1e-12));
    CHECK(test.expected == Approx(mean).margin(1e-12));
  }
}

TEST_CASE("A card-counter who is told the answers averages 8.7 of 25 without feeling anything") {
  RandomStream random(6, "chance test test");
  double right = 0.0;
  int found = 0;
  const int sessions = 4000;
  for (int session = 0; session < sessions; ++session) {
    const std::vector<int> presented = balanced_25(random);
    const AnsweredBlock block{presented, card_counter(presented)};
    right += right_in(presented, block.answered);
    const std::vector<AnsweredBlock> one{block};
    if (analysis::chance_test(5, one, OrderRule::permuted)->p <= 0.05) ++found;
  }
  CHECK(right / sessions == Approx(8.7).margin(0.1));
  CHECK(found > 0.2 * sessions);  // no test of counts can tell that from feeling
}

TEST_CASE("chance_test by redrawing comes near the exact p, and says that it is not exact") {
  const std::vector<AnsweredBlock> blocks{with_right(8), with_right(7)};
  const double exact = analysis::chance_test(5, blocks, OrderRule::permuted)->p;
  const auto redraw = [&](std::size_t block, int deal) {
    RandomStream random(7, "chance test test", 2 * static_cast<std::uint64_t>(deal) + block);
    return balanced_25(random);
  };
  const ChanceTest test = *analysis::chance_test(5, blocks, OrderRule::redrawn, redraw, 4000);
  CHECK_FALSE(test.exact);
  CHECK(test.deals == 4000);
  CHECK(std::abs(test.p - exact) < 4.0 * std::sqrt(exact * (1.0 - exact) / 4000.0) + 1.0 / 4000.0);
  CHECK(test.expected == Approx(10.0).margin(4.0 * 2.1 * std::sqrt(2.0 / 4000.0)));
}

TEST_CASE("A Monte Carlo p is never 0") {
  const std::vector<AnsweredBlock> all{with_right(25)};
  const auto wrong = [](std::size_t, int) { return std::vector<int>(25, 0); };
  CHECK(analysis::chance_test(5, all, OrderRule::redrawn, wrong, 99)->p == 0.01);
}

TEST_CASE("chance_test of a block too long to count shuffles it") {
  RandomStream random(8, "chance test test");
  const std::vector<AnsweredBlock> blocks{random_block(3, 401, random)};
  const ChanceTest test = *analysis::chance_test(3, blocks, OrderRule::permuted, {}, 199);
  CHECK_FALSE(test.exact);
  CHECK(test.deals == 199);
  CHECK(test.p >= 1.0 / 200.0);
  CHECK(test.p == analysis::chance_test(3, blocks, OrderRule::permuted, {}, 199)->p);
}

TEST_CASE("chance_test of a thousand participants nears the normal limit") {
  RandomStream random(9, "chance test test");
  std::vector<AnsweredBlock> blocks;
  double variance = 0.0;
  for (int i = 0; i < 1000; ++i) {
    AnsweredBlock block;
    block.presented = balanced_25(random);
    for (int k = 0; k < 25; ++k) block.answered.push_back(k / 5);
    variance += 25.0 * 25.0 / 24.0 * 0.2 * 0.8;  // n^2 / (n - 1) (1/K) (1 - 1/K)
    blocks.push_back(block);
  }
  const ChanceTest test = *analysis::chance_test(5, blocks, OrderRule::permuted);
  CHECK(test.exact);
  CHECK(test.expected == Approx(5000.0));
  const double z = (test.correct - 0.5 - test.expected) / std::sqrt(variance);
  CHECK(test.p == Approx(0.5 * std::erfc(z / std::sqrt(2.0))).margin(0.002));
}

TEST_CASE("chance_test at the ends: all right, all wrong, nothing answered, nothing presented") {
  const std::vector<AnsweredBlock> right{with_right(25)};
  CHECK(analysis::chance_test(5, right, OrderRule::permuted)->p == Approx(1.6042075331639573e-15));
  CHECK(analysis::chance_test(5, right, OrderRule::independent)->p == Approx(std::pow(0.2, 25)));
  const std::vector<AnsweredBlock> wrong{with_right(0)};
  CHECK(analysis::chance_test(5, wrong, OrderRule::permuted)->p == Approx(1.0).epsilon(1e-14));
  CHECK(analysis::chance_test(5, wrong, OrderRule::independent)->p == 1.0);
  const std::vector<AnsweredBlock> silent{{{0, 1, 1}, Answers(3)}};
  const ChanceTest none = *analysis::chance_test(2, silent, OrderRule::permuted);
  CHECK(none.p == 1.0);
  CHECK(none.expected == 0.0);
  CHECK(none.trials == 3);
  CHECK(analysis::chance_test(2, silent, OrderRule::independent)->p == 1.0);
  CHECK_FALSE(analysis::chance_test(5, {}, OrderRule::permuted).has_value());
  CHECK_FALSE(
      analysis::chance_test(5, std::vector<AnsweredBlock>(2), OrderRule::permuted).has_value());
}

TEST_CASE("With a single class nobody can do better than chance") {
  const std::vector<AnsweredBlock> one{{{1, 1, 1}, {1, 1, 0}}};
  CHECK(analysis::chance_test(2, one, OrderRule::permuted)->p == 1.0);
}

TEST_CASE("chance_test refuses impossible arguments") {
  const std::vector<AnsweredBlock> uneven{{{0, 1}, {0}}};
  CHECK_THROWS_AS(analysis::chance_test(2, uneven, OrderRule::permuted), std::invalid_argument);
  const std::vector<AnsweredBlock> unknown{{{0, 2}, {0, 1}}};
  CHECK_THROWS_AS(analysis::chance_test(2, unknown, OrderRule::permuted), std::invalid_argument);
  const std::vector<AnsweredBlock> answered{{{0, 1}, {0, 2}}};
  CHECK_THROWS_AS(analysis::chance_test(2, answered, OrderRule::independent),
                  std::invalid_argument);
  const std::vector<AnsweredBlock> good{{{0, 1}, {0, 1}}};
  CHECK_THROWS_AS(analysis::chance_test(2, good, OrderRule::redrawn), std::invalid_argument);
  const auto shorter = [](std::size_t, int) { return std::vector<int>{0}; };
  CHECK_THROWS_AS(analysis::chance_test(2, good, OrderRule::redrawn, shorter),
                  std::invalid_argument);
  const auto longer = [](std::size_t, int) { return std::vector<int>{0, 1}; };
  CHECK_THROWS_AS(analysis::chance_test(2, good, OrderRule::redrawn, longer, 0),
                  std::invalid_argument);
  CHECK_THROWS_AS(analysis::match_probabilities({{2, 1}}, 3), std::invalid_argument);
  CHECK_THROWS_AS(analysis::match_probabilities({{2, 3}}, 2), std::invalid_argument);
  CHECK_THROWS_AS(analysis::match_probabilities({{3, -1}}, 3), std::invalid_argument);
}

TEST_CASE("A p against chance is never 0, however many were right") {
  std::vector<AnsweredBlock> blocks(400);
  for (AnsweredBlock& block : blocks) {
    for (int i = 0; i < 20; ++i) {
      block.presented.push_back(i % 5);
      block.answered.emplace_back(i % 5);
    }
  }
  CHECK(analysis::chance_test(5, blocks, OrderRule::permuted)->p == 1e-280);
  CHECK(analysis::chance_test(5, blocks, OrderRule::independent)->p == 1e-280);
}

}  // namespace touchtrial
