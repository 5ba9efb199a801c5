#include "protocols/simulation/felt_decision.hpp"

#include "support/catch.hpp"

#include <cmath>
#include <functional>
#include <vector>

namespace touchtrial {
namespace {

const std::vector<std::string> kLabels = {"bark", "cloth", "straw"};

simulation::SubjectModel population() {
  return {.feature_noise = 0.3,
          .feature_noise_spread = 0.2,
          .lapse = 0.1,
          .lapse_spread = 0.8,
          .position_bias = 0.5,
          .position_bias_spread = 0.4,
          .class_bias = {{"cloth", 1.0}},
          .class_bias_spread = 0.6};
}

constexpr int kPeople = 4000;

struct Spread {
  double mean = 0.0;
  double sd = 0.0;
};

/// Of one number over many people.
Spread spread_of(const std::function<double(const simulation::Individual&)>& number) {
  const simulation::SubjectModel subject = population();
  std::vector<double> values;
  for (int i = 1; i <= kPeople; ++i)
    values.push_back(number(simulation::Individual(subject, 7, i)));
  Spread spread;
  for (const double value : values) spread.mean += value / kPeople;
  for (const double value : values) spread.sd += std::pow(value - spread.mean, 2) / (kPeople - 1);
  spread.sd = std::sqrt(spread.sd);
  return spread;
}

/// Within 4.5 standard errors: of a mean sd / sqrt(n), of a standard deviation sd / sqrt(2 n).
void check_normal(const Spread& found, double mean, double sd) {
  CHECK(std::abs(found.mean - mean) < 4.5 * sd / std::sqrt(kPeople));
  CHECK(std::abs(found.sd - sd) < 4.5 * sd / std::sqrt(2.0 * kPeople));
}

TEST_CASE("people of a population differ as its subject file says") {
  check_normal(spread_of([](const simulation::Individual& one) {
                 return std::log(one.noise().independent);
               }),
               std::log(0.3), 0.2);
  check_normal(spread_of([](const simulation::Individual& one) {
                 return std::log(one.lapse() / (1.0 - one.lapse()));
               }),
               std::log(0.1 / 0.9), 0.8);
  // Straw is last: no preference for its place, only for the class.
  check_normal(spread_of([](const simulation::Individual& one) { return one.bias(kLabels)[2]; }),
               0.0, 0.6);
  check_normal(spread_of([](const simulation::Individual& one) { return one.bias(kLabels)[0]; }),
               0.5, std::hypot(0.4, 0.6));
  check_normal(spread_of([](const simulation::Individual& one) { return one.bias(kLabels)[1]; }),
               1.25, std::hypot(0.2, 0.6));
}

TEST_CASE("without spreads everybody is as the subject file says, to the last digit") {
  simulation::SubjectModel subject = population();
  subject.feature_noise_spread = 0.0;
  subject.lapse_spread = 0.0;
  subject.position_bias_spread = 0.0;
  subject.class_bias_spread = 0.0;
  for (int i = 1; i <= 20; ++i) {
    const simulation::Individual one(subject, 3, i);
    CHECK(one.noise().independent == subject.feature_noise);
    CHECK(one.lapse() == subject.lapse);
    CHECK(one.bias(kLabels) == std::vector<double>{0.5, 1.25, 0.0});
  }
}

TEST_CASE("a preference belongs to the class wherever its picture lies") {
  simulation::SubjectModel subject = population();
  subject.position_bias = 0.0;
  subject.position_bias_spread = 0.0;
  const simulation::Individual one(subject, 3, 1);
  const std::vector<double> there = one.bias({"bark", "cloth", "straw"});
  const std::vector<double> elsewhere = one.bias({"straw", "bark", "cloth"});
  CHECK(there == std::vector<double>{elsewhere[1], elsewhere[2], elsewhere[0]});
}

TEST_CASE("one spread does not change the other differences between people") {
  const simulation::SubjectModel all = population();
  simulation::SubjectModel less = all;
  less.lapse_spread = 0.0;
  less.class_bias_spread = 0.0;
  const simulation::Individual one(all, 3, 5);
  const simulation::Individual other(less, 3, 5);
  CHECK(one.noise().independent == other.noise().independent);
  CHECK(one.lapse() != other.lapse());
  CHECK(one.noise().independent != simulation::Individual(all, 3, 6).noise().independent);
  CHECK(one.noise().independent != simulation::Individual(all, 4, 5).noise().independent);
}

TEST_CASE("a lapse of 0 or 1 is the same for everybody") {
  simulation::SubjectModel subject = population();
  for (const double lapse : {0.0, 1.0}) {
    subject.lapse = lapse;
    for (int i = 1; i <= 10; ++i) CHECK(simulation::Individual(subject, 1, i).lapse() == lapse);
  }
}

}  // namespace
}  // namespace touchtrial
