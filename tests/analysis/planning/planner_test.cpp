#include "analysis/planning/planner.hpp"

#include "core/errors.hpp"
#include "protocols/session/tiny_study.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <string_view>
#include <vector>

namespace touchtrial {
namespace {

using Protocols = std::vector<std::string_view>;

TEST_CASE("an option of power belongs to the protocols whose planners take it") {
  CHECK(planning::protocols_with("--trials") == Protocols{"threshold"});
  CHECK(planning::protocols_with("--mean") == Protocols{"classification", "comparison"});
  CHECK(planning::protocols_with("--seed").empty());
}

TEST_CASE("a planner without tracks or thresholds refuses them with the place") {
  const TinyStudy tiny;
  const planning::Planner& planner = planning::planner_of(tiny.key().study, "`power`");
  CHECK(planner.study_with_tracks().empty());
  CHECK_THROWS_AS(planner.procedure(tiny.key().study, 1, {}), UsageError);
  CHECK_THROWS_WITH(planner.pilot_thresholds({}, "s.json: /rendering/gains/curve: pilots.db"),
                    names("s.json /rendering/gains/curve pilots.db"));
}

}  // namespace
}  // namespace touchtrial
