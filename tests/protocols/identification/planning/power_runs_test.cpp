#include "protocols/identification/planning/power_runs.hpp"

#include "core/errors.hpp"
#include "protocols/identification/planning/power_report.hpp"
#include "protocols/identification/planning/rehearsed_tiny_study.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"

#include <algorithm>
#include <set>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

planning::PowerPlan plan_of(const std::vector<int>& sizes, int runs = 1000) {
  return {.participants = sizes, .runs = runs};
}

std::string refusal(planning::PowerPlan plan) {
  return message_of<UsageError>([&] { planning::validate_plan(plan); });
}

TEST_CASE("sizes may be in any order, but each only once") {
  planning::PowerPlan plan = plan_of({20, 8, 12});
  planning::validate_plan(plan);
  CHECK(plan.participants == std::vector<int>{8, 12, 20});
  CHECK_THAT(refusal(plan_of({8, 12, 8})), names("--participants 8"));
}

TEST_CASE("an impossible plan is refused with the option and its range") {
  CHECK_THAT(refusal(plan_of({})), holds_text("--participants"));
  CHECK_THAT(refusal(plan_of({1, 8})), names("--participants 1"));
  CHECK_THAT(refusal(plan_of({8, 1000000000})), holds_text("1000000000"));
  CHECK_THAT(refusal(plan_of({8}, 0)), holds_text("--runs"));
  CHECK_THAT(refusal(plan_of({8}, -5)), holds_text("--runs"));
  CHECK_THAT(refusal(plan_of({8}, 2000000000)), holds_text("--runs"));
  CHECK_THAT(refusal(plan_of(std::vector<int>(65, 8))), names("--participants 65"));
  std::vector<int> many;
  for (int i = 2; i < 40; ++i) many.push_back(i);
  CHECK_THAT(refusal(plan_of(many, 100000)), names("--runs 100000 38"));
}

TEST_CASE("every simulated study has a seed of its own") {
  std::set<std::uint64_t> seeds;
  for (const int size : {8, 12}) {
    for (const planning::identification::Hypothesis hypothesis :
         {planning::identification::Hypothesis::population,
          planning::identification::Hypothesis::null}) {
      for (int run = 0; run < 100; ++run) {
        seeds.insert(planning::identification::study_seed(1, size, hypothesis, run));
        seeds.insert(planning::identification::study_seed(2, size, hypothesis, run));
      }
    }
  }
  CHECK(seeds.size() == 800);
}

/// The runs of a plan by hand: `run_of` makes each from its size, hypothesis and number.
template <typename RunOf>
planning::identification::PowerRuns runs_by_hand(int runs, const RunOf& run_of) {
  planning::identification::PowerRuns power{{}, plan_of({3, 5}, runs), {}};
  for (const int size : power.plan.participants) {
    for (const auto hypothesis : {planning::identification::Hypothesis::population,
                                  planning::identification::Hypothesis::null}) {
      planning::identification::PowerCell& cell = power.cells.emplace_back();
      cell.participants = size;
      cell.hypothesis = hypothesis;
      for (int run = 0; run < runs; ++run) cell.runs.push_back(run_of(cell, run));
    }
  }
  return power;
}

TEST_CASE("a power run is the same with any number of threads, and keeps its first runs") {
  TinyStudyOptions options{.side_px = 60, .trials = R"({"repeats":2})"};
  const RehearsedTinyStudy tiny(options);
  const planning::identification::PrecomputedPerception bank = tiny.bank();
  const auto made = [&](int runs, int jobs) {
    return planning::identification::make_runs(tiny.planned(bank), tiny.test, {},
                                               plan_of({3, 5}, runs), jobs)
        .cells;
  };
  const std::vector<planning::identification::PowerCell> one = made(130, 1);
  CHECK(one == made(130, 3));
  CHECK(one.size() == 4);
  const std::vector<planning::identification::PowerCell> fewer = made(20, 2);
  for (std::size_t i = 0; i < one.size(); ++i) {
    CHECK(std::equal(fewer[i].runs.begin(), fewer[i].runs.end(), one[i].runs.begin()));
  }
}

TEST_CASE("a bank of feelings is the same with any number of threads") {
  const RehearsedTinyStudy tiny;
  const planning::identification::PrecomputedPerception one = tiny.bank(3, 2, 1, 1);
  const planning::identification::PrecomputedPerception other = tiny.bank(3, 2, 1, 3);
  for (std::uint64_t draw = 0; draw < 3; ++draw) {
    CHECK(one.felt({1, 0, 0}, {5, 1, 1, draw}) == other.felt({1, 0, 0}, {5, 1, 1, draw}));
  }
  CHECK(one.felt({1, 0, 0}, {5, 1, 1, 0}) != one.felt({1, 0, 0}, {5, 1, 1, 1}));
  CHECK(one.knowledge(7)->examples.front().features ==
        other.knowledge(7)->examples.front().features);
}

TEST_CASE("the report of a power run agrees with its runs") {
  const planning::identification::PowerReport report = planning::identification::make_power_report(
      runs_by_hand(4,
                   [](const planning::identification::PowerCell& cell,
                      int run) -> planning::identification::PowerRun {
                     const double width = cell.participants == 3 ? 0.4 : 0.2;
                     const bool null =
                         cell.hypothesis == planning::identification::Hypothesis::null;
                     const double p = null ? 0.5 : run == 0 && cell.participants == 3 ? 0.06 : 0.01;
                     return {p, null ? 0.04 : 0.0, 0.5, 0.5 - width / 2, 0.5 + width / 2};
                   }));
  REQUIRE(report.rows.size() == 2);
  CHECK(report.rows[0].significant == (analysis::Proportion{4, 3}));
  CHECK(report.rows[1].significant == (analysis::Proportion{4, 4}));
  CHECK(report.rows[0].width.mean == Approx(0.4));
  CHECK(report.rows[1].width.median == Approx(0.2));
  CHECK(report.rows[0].false_alarms == (analysis::Proportion{4, 0}));
  CHECK(report.rows[0].attainable == Approx(0.04));
  CHECK(report.targets[0].smallest == 5);
  CHECK_FALSE(report.targets[0].smallest_certain.has_value());
  const auto json = nlohmann::json::parse(planning::identification::power_json(report));
  CHECK(json.at("simulated") == true);
  CHECK(json.at("stamp") == "SIMULATED");
  CHECK(json.at("sizes").at(1).at("power").at("p") == 1.0);
  CHECK(json.at("targets").at(1).at("smallest") == 5);
  const std::string text = planning::identification::power_text(report);
  CHECK(text.starts_with(planning::identification::power_stamp(report.setting)));
  CHECK(text.ends_with(planning::identification::power_stamp(report.setting) + "\n"));
}

TEST_CASE("there is no verdict on the test's error for orders with unequal counts of classes") {
  planning::identification::PowerRuns power =
      runs_by_hand(100, [](const planning::identification::PowerCell&, int) {
        return planning::identification::PowerRun{0.01, 0.04, 0.5, 0.4, 0.6};
      });
  const auto report = [&] { return planning::identification::make_power_report(power); };
  CHECK(planning::identification::verdict_of(report().rows[0]) ==
        planning::identification::ErrorVerdict::excessive);
  const std::size_t warnings = report().warnings.size();
  power.setting.has_fixed_counts = false;
  CHECK(planning::identification::verdict_of(report().rows[0]) ==
        planning::identification::ErrorVerdict::conditional);
  CHECK(report().warnings.size() == warnings - 2);  // one for each size
}

}  // namespace
}  // namespace touchtrial
