#include "analysis/statistics/paired_tests.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace touchtrial {
namespace {

using Occasions = std::vector<std::vector<bool>>;

const Occasions kEight{{true, true, false},  {true, true, true},  {false, true, false},
                       {true, false, false}, {true, true, false}, {false, false, false},
                       {true, true, false},  {false, true, false}};

/// The p of exchanging three methods in every way within each of `participants`, all listed.
double p_by_listing(const std::vector<Occasions>& participants) {
  const auto together = [](const std::vector<Occasions>& all) {
    Occasions flat;
    for (const Occasions& mine : all) flat.insert(flat.end(), mine.begin(), mine.end());
    return analysis::cochran_q(flat)->q;
  };
  const double observed = together(participants);
  int as_far = 0;
  int ways = 1;
  for (std::size_t i = 0; i < participants.size(); ++i) ways *= 6;
  for (int way = 0; way < ways; ++way) {
    std::vector<Occasions> exchanged = participants;
    int rest = way;
    for (Occasions& mine : exchanged) {
      std::vector<int> order{0, 1, 2};
      for (int k = 0; k < rest % 6; ++k) std::next_permutation(order.begin(), order.end());
      rest /= 6;
      for (std::vector<bool>& occasion : mine) {
        occasion = {occasion[order[0]], occasion[order[1]], occasion[order[2]]};
      }
    }
    if (together(exchanged) >= observed - 1e-9) ++as_far;
  }
  return static_cast<double>(as_far) / ways;
}

}  // namespace

// Expected values: statsmodels 0.13, cochrans_q.
TEST_CASE("cochran_q gives the values of an independent implementation") {
  const analysis::CochranQ result = *analysis::cochran_q(kEight);
  CHECK(result.q == Approx(7.0).epsilon(1e-12));
  CHECK(result.degrees_of_freedom == 2);
  CHECK(result.p == Approx(0.0301973834223185).epsilon(1e-12));
}

TEST_CASE("With two methods cochran_q is McNemar's chi-square") {
  Occasions occasions;
  for (int i = 0; i < 9; ++i) occasions.push_back({true, false});
  for (int i = 0; i < 4; ++i) occasions.push_back({false, true});
  for (int i = 0; i < 7; ++i) occasions.push_back({true, true});
  const analysis::CochranQ result = *analysis::cochran_q(occasions);
  CHECK(result.q == Approx(25.0 / 13.0));
  CHECK(result.p == Approx(std::erfc(std::sqrt(25.0 / 13.0 / 2.0))));
}

TEST_CASE("cochran_q ignores occasions without information, and the methods' order") {
  Occasions occasions = kEight;
  for (std::vector<bool>& occasion : occasions) std::reverse(occasion.begin(), occasion.end());
  occasions.push_back({true, true, true});
  occasions.push_back({false, false, false});
  CHECK(analysis::cochran_q(occasions)->q == Approx(analysis::cochran_q(kEight)->q));
}

TEST_CASE(
    "cochran_q is 0 with p 1 where differences balance, and nothing where no methods differ") {
  CHECK(analysis::cochran_q(Occasions{{true, false}, {false, true}})->q == 0.0);
  CHECK(analysis::cochran_q(Occasions{{true, false}, {false, true}})->p == 1.0);
  CHECK_FALSE(analysis::cochran_q({}).has_value());
  CHECK_FALSE(analysis::cochran_q(Occasions{{true, true}, {false, false}}).has_value());
  CHECK_FALSE(analysis::cochran_q(Occasions{{true}, {false}}).has_value());
}

TEST_CASE("cochran_q_permuted_p nears the p of all exchanges") {
  const std::vector<Occasions> participants{
      {{true, false, false}, {true, true, false}, {true, false, true}},
      {{true, false, false}, {true, false, false}},
      {{true, true, false}, {false, true, false}, {true, false, false}},
      {{true, true, true}, {true, false, false}, {true, true, false}}};
  const double exact = p_by_listing(participants);
  const double error = std::sqrt(exact * (1.0 - exact) / 9999.0);
  CHECK(exact < 0.2);
  CHECK(std::abs(*analysis::cochran_q_permuted_p(participants) - exact) < 4.0 * error + 1e-4);
}

TEST_CASE("cochran_q_permuted_p treats a participant as one, however many occasions repeat") {
  const std::vector<Occasions> once{{{true, false, false}}, {{true, false, false}}};
  const std::vector<Occasions> often{Occasions(50, {true, false, false}),
                                     Occasions(50, {true, false, false})};
  CHECK(analysis::cochran_q_permuted_p(once) == analysis::cochran_q_permuted_p(often));
  CHECK(*analysis::cochran_q_permuted_p(often) == Approx(1.0 / 3.0).margin(0.02));
}

TEST_CASE("cochran_q_permuted_p is nothing where no method differs, and repeats itself") {
  CHECK_FALSE(analysis::cochran_q_permuted_p({}).has_value());
  CHECK_FALSE(
      analysis::cochran_q_permuted_p(std::vector<Occasions>{{}, {{true, true}}}).has_value());
  const std::vector<Occasions> one{kEight};
  CHECK(analysis::cochran_q_permuted_p(one, 99) == analysis::cochran_q_permuted_p(one, 99));
}

TEST_CASE("cochran_q refuses occasions of unequal length") {
  const Occasions ragged{{true, false}, {true}};
  CHECK_THROWS_AS(analysis::cochran_q(ragged), std::invalid_argument);
  CHECK_THROWS_AS(analysis::cochran_q_permuted_p(std::vector<Occasions>{ragged}),
                  std::invalid_argument);
  CHECK_THROWS_AS(analysis::cochran_q_permuted_p(std::vector<Occasions>{kEight}, 0),
                  std::invalid_argument);
}

}  // namespace touchtrial
