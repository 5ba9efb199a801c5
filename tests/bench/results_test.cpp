#include "bench/results.hpp"

#include "core/errors.hpp"
#include "support/catch.hpp"

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial::bench {
namespace {

GoalResult ratio_result(double ratio, double target) {
  GoalResult result;
  result.goal = "filter";
  result.peer = "peer";
  result.ours_us = 100.0 * ratio;
  result.peer_us = 100.0;
  result.ratio = ratio;
  result.error = 1e-6;
  result.error_unit = "grey levels";
  result.target = target;
  return result;
}

TEST_CASE("a goal is met up to its target, and not where nothing was measured") {
  CHECK(is_met(ratio_result(0.5, 0.5)));
  CHECK_FALSE(is_met(ratio_result(0.51, 0.5)));
  CHECK_FALSE(is_met(ratio_result(kNotTaken, 0.5)));
}

TEST_CASE("a goal is judged by the number that its target limits") {
  GoalResult result = ratio_result(2.0, 1e-5);
  CHECK_FALSE(is_met(result));
  result.limit = Limit::error;
  CHECK(is_met(result));
  result.limit = Limit::time_us;
  CHECK_FALSE(is_met(result));
  result.limit = Limit::count;
  result.count = 0.0;
  CHECK(is_met(result));
}

TEST_CASE("the table says whether each goal is met, and says nothing about lines for the record") {
  const std::string table =
      goals_table({ratio_result(0.4, 0.5), ratio_result(0.6, 0.5), ratio_result(0.6, kNotTaken)});
  CHECK_THAT(table,
             holds_text("| 40.0 us | peer | 100 us      | 0.400 |       |          | <= 0.5 |"));
  CHECK_THAT(table, holds_text("| yes    |"));
  CHECK_THAT(table, holds_text("| **no** |"));
  CHECK_THAT(table,
             holds_text("| 0.600 |       |          |        | 1.0e-06 grey levels |        |"));
}

TEST_CASE("a goal beside a bound is judged by it, and the table names the bound") {
  GoalResult result = ratio_result(0.1, 1.6);
  result.limit = Limit::of_bound;
  CHECK_FALSE(is_met(result));
  result.bound = "memory";
  result.bound_us = 20.0;
  result.of_bound = 1.7;
  CHECK_FALSE(is_met(result));
  result.of_bound = 1.5;
  CHECK(is_met(result));
  CHECK_THAT(goals_table({result}), holds_text("| memory, 20.0 us | 1.50     | <= 1.6 of bound |"));
}

TEST_CASE("what is slower by more than a tenth than the committed results is named") {
  GoalResult before = ratio_result(0.4, 0.5);
  before.of_bound = 1.5;
  before.bound = "memory";
  const std::string committed = results_json({}, {{before}, {}, {}});
  GoalResult now = before;
  now.ratio = 0.43;
  now.of_bound = 1.64;
  CHECK(slower_than_committed({now}, committed).empty());
  now.ratio = 0.45;
  CHECK(slower_than_committed({now}, committed) ==
        std::vector<std::string>{"filter: 0.450 of peer, and 0.400 in the committed results"});
  now.of_bound = 1.7;
  CHECK(slower_than_committed({now}, committed).size() == 2);
  now.goal = "another";
  CHECK(slower_than_committed({now}, committed).empty());
  now.goal = before.goal;
  now.peer = "another peer";
  CHECK(slower_than_committed({now}, committed).empty());
  CHECK_THROWS_AS(slower_than_committed({now}, "{}"), Error);
  CHECK_THROWS_AS(slower_than_committed({now}, "not JSON"), Error);
  CHECK(processor_of(results_json({"Z80, 8 bits", "", "", ""}, {})) == "Z80, 8 bits");
  CHECK_THROWS_AS(processor_of("{}"), Error);
}

TEST_CASE("results_json holds every goal and row, with null for what was not taken") {
  Row row;
  row.what.work = "filter";
  row.what.who = "touchtrial";
  row.what.size_px = 500;
  row.us = 92.0;
  const auto json = nlohmann::json::parse(
      results_json({"processor", "compiler", "4.6", "2026-01-01"},
                   {{ratio_result(0.4, 0.5), ratio_result(0.6, kNotTaken)}, {row}, {}}));
  CHECK(json["processor"] == "processor");
  CHECK(json["goals"][0]["met"] == true);
  CHECK(json["goals"][0]["ratio"] == 0.4);
  CHECK(json["goals"][1]["met"].is_null());
  CHECK(json["rows"][0]["us"] == 92.0);
  CHECK(json["rows"][0]["error"].is_null());
  CHECK(json["rows"][0]["radius"].is_null());
}

const std::string kPage = "# Title\n\n<!-- goals -->\nold\n<!-- end of goals -->\n\nrest\n";

TEST_CASE("with_section replaces only the text between its two lines") {
  CHECK(with_section(kPage, "goals", "new\n") ==
        "# Title\n\n<!-- goals -->\n\nnew\n\n<!-- end of goals -->\n\nrest\n");
}

TEST_CASE("with_section is idempotent") {
  const std::string once = with_section(kPage, "goals", "new\n");
  CHECK(with_section(once, "goals", "new\n") == once);
}

TEST_CASE("with_section refuses a page without the section, and says which lines are missing") {
  CHECK_THROWS_AS(with_section("# Title\n", "goals", "new\n"), Error);
  CHECK_THROWS_WITH(with_section("<!-- goals -->\n", "goals", ""),
                    holds_text("<!-- end of goals -->"));
  CHECK_THROWS_AS(with_section("<!-- end of goals -->\n<!-- goals -->\n", "goals", ""), Error);
}

}  // namespace

}  // namespace touchtrial::bench
