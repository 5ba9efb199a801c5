#include "analysis/planning/power_plan.hpp"

#include "core/errors.hpp"
#include "core/random.hpp"
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

std::vector<planning::PowerRun> runs_with(int significant, int of) {
  std::vector<planning::PowerRun> runs(static_cast<std::size_t>(of),
                                       planning::PowerRun{1.0, 0.0, 0.0, 0.0, 0.0});
  for (int i = 0; i < significant; ++i) runs[static_cast<std::size_t>(i)].p = 0.01;
  return runs;
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

TEST_CASE("each run belongs to exactly one shard") {
  for (const int count : {1, 3, 7, 16}) {
    for (const int runs : {1, 5, 16, 100}) {
      std::multiset<int> made;
      for (int number = 1; number <= count; ++number) {
        const planning::Shard shard{number, count};
        for (int i = 0; i < shard.own_runs(runs); ++i) made.insert(shard.run(i));
      }
      CHECK(static_cast<int>(made.size()) == runs);
      for (int run = 0; run < runs; ++run) CHECK(made.count(run) == 1);
    }
  }
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

TEST_CASE("the numbers of runs at the looks double, and the last look is at the plan's end") {
  CHECK(planning::looks_of(plan_of({8}, 1000)) == std::vector<int>{100, 200, 400, 800, 1000});
  CHECK(planning::looks_of(plan_of({8}, 100)) == std::vector<int>{100});
  CHECK(planning::looks_of(plan_of({8}, 7)) == std::vector<int>{7});
  planning::PowerPlan patient = plan_of({8}, 1000);
  patient.stop_early = false;
  CHECK(planning::looks_of(patient) == std::vector<int>{1000});
}

TEST_CASE("a size stops if its power lies above or below all targets, but not in between") {
  const planning::PowerPlan plan = plan_of({8}, 1000);
  CHECK(planning::certain_after(plan, runs_with(100, 100)) == 100);
  CHECK(planning::certain_after(plan, runs_with(10, 150)) == 100);
  CHECK_FALSE(planning::certain_after(plan, runs_with(99, 99)).has_value());
  CHECK_FALSE(planning::certain_after(plan, runs_with(85, 100)).has_value());
  planning::PowerPlan patient = plan;
  patient.stop_early = false;
  CHECK_FALSE(planning::certain_after(patient, runs_with(100, 100)).has_value());
}

TEST_CASE("once an answer is certain, more runs do not move its look") {
  const planning::PowerPlan plan = plan_of({8}, 1000);
  auto runs = runs_with(100, 100);
  const auto more = runs_with(0, 300);
  runs.insert(runs.end(), more.begin(), more.end());
  CHECK(planning::certain_after(plan, runs) == 100);
}

TEST_CASE("stopping early is seldom wrong about its targets, even for powers near them") {
  // True powers close to each target, where stopping is most likely to be wrong.
  planning::PowerPlan plan = plan_of({8}, 1000);
  RandomStream random(4, "stopping early");
  constexpr int kStudies = 600;
  for (const double power : {0.79, 0.81, 0.89, 0.91}) {
    int wrong = 0;
    for (int study = 0; study < kStudies; ++study) {
      std::vector<planning::PowerRun> runs(1000);
      for (planning::PowerRun& run : runs) run.p = random.uniform() < power ? 0.01 : 1.0;
      const int made = planning::certain_after(plan, runs).value_or(plan.runs);
      int significant = 0;
      for (int i = 0; i < made; ++i) significant += planning::is_significant(runs[i], 0.05) ? 1 : 0;
      const analysis::Interval interval = planning::power_interval(plan, {made, significant});
      if (power < interval.low || power > interval.high) ++wrong;
    }
    // 5 % of 600 is 30, and four standard errors are 21 more.
    CHECK(wrong <= 51);
  }
}

}  // namespace
}  // namespace touchtrial
