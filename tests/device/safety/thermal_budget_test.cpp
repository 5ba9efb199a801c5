#include "device/safety/thermal_budget.hpp"

#include "support/catch.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial {
namespace {

constexpr double kTickS = 0.001;
constexpr device::SafetyLimits kOmni{
    .max_force_n = 3.3, .continuous_force_n = 0.88, .thermal_budget_s = 20.0};

/// Sends as much of a force as the budget allows. \return the force of the last tick
double push(device::ThermalBudget& budget, double force_n, double time_s) {
  double sent_n = 0.0;
  double hottest = 0.0;
  for (int tick = 0; tick < std::lround(time_s / kTickS); ++tick) {
    sent_n = std::min(force_n, budget.limit_n());
    budget.heat(sent_n * sent_n, 1.0);
    hottest = std::max(hottest, budget.share_of_heat());
  }
  REQUIRE(hottest <= 1.0);
  return sent_n;
}

TEST_CASE("a cold motor gives its peak force for the time of the budget, then less") {
  device::ThermalBudget budget(kOmni, kTickS);
  CHECK(push(budget, 3.3, 19.9) == 3.3);
  CHECK(push(budget, 3.3, 0.2) < 3.3);
}

TEST_CASE("in the long run a motor gives no more than its continuous force, and never less") {
  device::ThermalBudget budget(kOmni, kTickS);
  const double at_last_n = push(budget, 3.3, 2000.0);
  CHECK(at_last_n == Approx(0.88).epsilon(0.02));
  CHECK(at_last_n >= 0.88);
}

TEST_CASE("what a hand presses a texture with is never limited") {
  device::ThermalBudget budget(kOmni, kTickS);
  CHECK(push(budget, 0.7, 3600.0) == 0.7);
  CHECK(budget.limit_n() == 3.3);
}

TEST_CASE("the limit falls without a step") {
  device::ThermalBudget budget(kOmni, kTickS);
  double last_n = 3.3;
  double largest_step_n = 0.0;
  for (int tick = 0; tick < 100'000; ++tick) {
    budget.heat(last_n * last_n, 1.0);
    largest_step_n = std::max(largest_step_n, std::abs(budget.limit_n() - last_n));
    last_n = budget.limit_n();
  }
  CHECK(largest_step_n < 0.002);
  CHECK(last_n < 1.0);
}

TEST_CASE(
    "a motor that worked before a run is warm when it begins, the less the longer it rested") {
  device::ThermalBudget earlier(kOmni, kTickS);
  push(earlier, 3.3, 15.0);
  device::ThermalBudget at_once(kOmni, kTickS);
  at_once.begin_warm(earlier.heat_n2(), 0.0);
  CHECK(at_once.share_of_heat() == earlier.share_of_heat());
  CHECK(push(at_once, 3.3, 10.0) < 3.3);
  device::ThermalBudget rested(kOmni, kTickS);
  rested.begin_warm(earlier.heat_n2(), 3600.0);
  CHECK(push(rested, 3.3, 19.0) == 3.3);
  device::ThermalBudget no_clock(kOmni, kTickS);
  no_clock.begin_warm(earlier.heat_n2(), -5.0);
  CHECK(no_clock.share_of_heat() == earlier.share_of_heat());
}

TEST_CASE("heat that is no number, and a device without a budget, begin cold") {
  device::ThermalBudget budget(kOmni, kTickS);
  budget.begin_warm(std::nan(""), 0.0);
  CHECK(budget.share_of_heat() == 0.0);
  device::ThermalBudget none({.max_force_n = 3.3}, kTickS);
  none.begin_warm(5.0, 0.0);
  CHECK(none.limit_n() == 3.3);
}

TEST_CASE("a motor that rests gets its peak force back") {
  device::ThermalBudget budget(kOmni, kTickS);
  static_cast<void>(push(budget, 3.3, 60.0));
  REQUIRE(budget.limit_n() < 3.0);
  static_cast<void>(push(budget, 0.0, 60.0));
  CHECK(budget.limit_n() == 3.3);
}

TEST_CASE("late ticks warm a motor for as long as they lasted") {
  device::ThermalBudget every(kOmni, kTickS);
  device::ThermalBudget late(kOmni, kTickS);
  for (int tick = 0; tick < 10'000; ++tick) every.heat(4.0, 1.0);
  for (int tick = 0; tick < 1000; ++tick) late.heat(4.0, 10.0);
  CHECK(late.share_of_heat() == Approx(every.share_of_heat()).epsilon(1e-3));
  late.heat(4.0, 1e12);
  CHECK(late.share_of_heat() == Approx(4.0 / (0.88 * 0.88)));
}

TEST_CASE("without a continuous force, or with one above the peak, there is no budget") {
  device::SafetyLimits limits = kOmni;
  limits.continuous_force_n = GENERATE(0.0, 3.3, 8.0);
  device::ThermalBudget budget(limits, kTickS);
  CHECK(push(budget, 3.3, 300.0) == 3.3);
  CHECK(budget.share_of_heat() == 0.0);
}

}  // namespace
}  // namespace touchtrial
