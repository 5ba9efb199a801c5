#include "analysis/planning/power_plan.hpp"

#include "core/errors.hpp"
#include "support/catch.hpp"

#include <set>

namespace touchtrial {
namespace {

planning::PowerPlan plan_of(const std::vector<int>& sizes, int runs = 1000) {
  planning::PowerPlan plan;
  plan.participants = sizes;
  plan.runs = runs;
  return plan;
}

std::string refusal(planning::PowerPlan plan) {
  try {
    planning::settle(plan);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST_CASE("sizes may be in any order, but each only once") {
  planning::PowerPlan plan = plan_of({20, 8, 12});
  planning::settle(plan);
  CHECK(plan.participants == std::vector<int>{8, 12, 20});
  CHECK_THAT(refusal(plan_of({8, 12, 8})), holds_text("8 is given twice"));
}

TEST_CASE("an impossible plan is refused with the option and its range") {
  CHECK_THAT(refusal(plan_of({})), holds_text("--participants"));
  CHECK_THAT(refusal(plan_of({1, 8})), holds_text("1 is out of range"));
  CHECK_THAT(refusal(plan_of({8, 1000000000})), holds_text("1000000000"));
  CHECK_THAT(refusal(plan_of({8}, 0)), holds_text("--runs"));
  CHECK_THAT(refusal(plan_of({8}, -5)), holds_text("--runs"));
  CHECK_THAT(refusal(plan_of({8}, 2000000000)), holds_text("--runs"));
  CHECK_THAT(refusal(plan_of(std::vector<int>(65, 8))), holds_text("65 sizes"));
  std::vector<int> many;
  for (int i = 2; i < 40; ++i) many.push_back(i);
  CHECK_THAT(refusal(plan_of(many, 100000)), holds_text("in all"));
}

TEST_CASE("every simulated study has a seed of its own") {
  std::set<std::uint64_t> seeds;
  for (const int size : {8, 12}) {
    for (const planning::Hypothesis hypothesis :
         {planning::Hypothesis::population, planning::Hypothesis::null}) {
      for (int run = 0; run < 100; ++run) {
        seeds.insert(planning::study_seed(1, size, hypothesis, run));
        seeds.insert(planning::study_seed(2, size, hypothesis, run));
      }
    }
  }
  CHECK(seeds.size() == 800);
}

}  // namespace
}  // namespace touchtrial
