#include "analysis/statistics/global_null_test.hpp"

#include "analysis/statistics/chance_test.hpp"
#include "core/random.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::analysis;

namespace {

constexpr int kDeals = 999;

/// A participant's own p, and p of deals that are whole multiples of 1/20.
std::vector<double> with_deals(double own, int person) {
  RandomStream random(5, "anybody test", static_cast<std::uint64_t>(person));
  std::vector<double> p{own};
  for (int deal = 0; deal < kDeals; ++deal) {
    p.push_back(static_cast<double>(random.below(20) + 1) / 20.0);
  }
  return p;
}

/// What people together do says nothing.
GlobalNullResult tested(const std::vector<double>& own) {
  GlobalNullTest test(static_cast<int>(own.size()), kDeals);
  for (std::size_t i = 0; i < own.size(); ++i) {
    test.add(with_deals(own[i], static_cast<int>(i)));
  }
  return test.result(std::vector<double>(kDeals + 1));
}

}  // namespace

TEST_CASE("the p of a statistic among others is the share that is as large") {
  CHECK(ranked_p(std::vector{2.0, 3.0, 1.0, 2.0}) == std::vector{0.75, 0.25, 1.0, 0.75});
  CHECK(ranked_p(std::vector{0.1 + 0.2, 0.3}) == std::vector{1.0, 1.0});
  CHECK(ranked_p(std::vector<double>{}).empty());
}

TEST_CASE("who stands out by Holm is somebody, whatever all others do") {
  std::vector<double> own(12, 1.0);
  own[7] = 0.004;
  const GlobalNullResult found = tested(own);
  CHECK(found.found());
  CHECK(found.p <= 12 * 0.004);
  CHECK(found.people == 12);
  CHECK(found.alone == 1);
  CHECK(found.alone_by_chance == Approx(12 * 0.05).margin(0.05));
  own[7] = 0.05;
  CHECK_FALSE(tested(own).found());
}

TEST_CASE("several of whom nobody stands out are found by their product") {
  std::vector<double> own(12, 0.5);
  std::fill(own.begin(), own.begin() + 4, 0.05);
  const GlobalNullResult found = tested(own);
  CHECK(found.p < 0.02);
  CHECK(found.alone == 4);
}

TEST_CASE("all together are found where everybody is a little better") {
  GlobalNullTest test(3, kDeals);
  for (int person = 0; person < 3; ++person) test.add(with_deals(0.4, person));
  std::vector<double> together(kDeals + 1);
  CHECK_FALSE(test.result(together).found());
  together.front() = 1.0;
  CHECK(test.result(together).p == Approx(2.0 / (kDeals + 1)).margin(0.002));
}

TEST_CASE("one level holds for everything that is looked at") {
  constexpr int kStudies = 400;
  int found = 0;
  for (int study = 0; study < kStudies; ++study) {
    RandomStream random(6, "anybody: level", static_cast<std::uint64_t>(study));
    GlobalNullTest test(8, 199);
    std::vector<double> together(200);
    for (int person = 0; person < 8; ++person) {
      std::vector<double> p;
      for (double& sum : together) {
        p.push_back(static_cast<double>(random.below(200) + 1) / 200.0);
        sum -= p.back();
      }
      test.add(p);
    }
    found += test.result(together).found() ? 1 : 0;
  }
  // 20 are expected; the standard deviation is 4.4.
  CHECK(found > 6);
  CHECK(found < 34);
}

TEST_CASE("nobody is nobody, and what is no p is refused") {
  CHECK(GlobalNullTest(0, 9).result(std::vector<double>(10)).p == 1.0);
  CHECK_THROWS_AS(GlobalNullTest(1, 0), std::invalid_argument);
  GlobalNullTest test(1, 2);
  CHECK_THROWS_AS(test.add(std::vector{0.5, 0.5}), std::invalid_argument);
  CHECK_THROWS_AS(test.add(std::vector{0.5, 0.0, 0.5}), std::invalid_argument);
  CHECK_THROWS_AS(test.add(std::vector{0.5, 1.5, 0.5}), std::invalid_argument);
  CHECK_THROWS_AS(test.result(std::vector{1.0, 1.0, 1.0}), std::invalid_argument);
  test.add(std::vector{0.5, 0.5, 1.0});
  CHECK_THROWS_AS(test.result(std::vector{1.0}), std::invalid_argument);
  CHECK(test.result(std::vector{1.0, 0.0, 0.0}).p == Approx(1.0 / 3.0));
}
