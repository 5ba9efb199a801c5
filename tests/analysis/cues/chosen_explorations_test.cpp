#include "analysis/cues/chosen_explorations.hpp"

#include "analysis/cues/felt_fixtures.hpp"
#include "analysis/fake_study.hpp"
#include "core/errors.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace touchtrial {
namespace {

Trace wave(const Presentation& /*shown*/) {
  return stroking_over_wave(3.0, 0.2);
}

TEST_CASE("a trial's name is a participant's, a colon and a number from 1") {
  CHECK(trial_name("P01:12").participant == "P01");
  CHECK(trial_name("P01:12").trial == 12);
  CHECK(trial_name("a:b:3").participant == "a:b");
  for (const std::string wrong :
       {"", "P01", "P01:", ":3", "P01:0", "P01:-1", "P01:3x", "P01: 3", "P01:99999999999"}) {
    INFO(wrong);
    REQUIRE_THROWS_AS(trial_name(wrong), UsageError);
  }
}

TEST_CASE("without a choice each method's first counted trial is drawn") {
  FakeStudy study(Protocol::comparison);
  study.add({.participant = "P01",
             .enrolment = 1,
             .answers = FakeStudy::always_right(),
             .complete = false,
             .stop_after = 1,
             .traces = wave});
  study.add(
      {.participant = "P02", .enrolment = 2, .answers = FakeStudy::always_right(), .traces = wave});
  study.close_and_unblind();
  const Outcomes outcomes = load_outcomes(study.store(), study.key());
  const auto paths = first_explorations(study.store(), study.key(), outcomes);
  REQUIRE(paths.size() == 2);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    CHECK(paths[i].method == outcomes.methods[i]);
    CHECK(paths[i].participant == "P02");
  }
  CHECK(std::min(paths[0].trial, paths[1].trial) == 1);
}

TEST_CASE("a named trial is drawn, counted or not, and one that is not there is refused") {
  FakeStudy study(Protocol::classification);
  study.add({.participant = "P01", .answers = FakeStudy::always_right(), .traces = wave});
  study.close_and_unblind();
  const Outcomes outcomes = load_outcomes(study.store(), study.key());
  const ExplorationPath path =
      exploration_named(study.store(), study.key(), outcomes, trial_name("P01:3"));
  CHECK(path.participant == "P01");
  CHECK(path.trial == 3);
  for (const std::string absent : {"P01:99", "P02:1"}) {
    REQUIRE_THROWS_AS(exploration_named(study.store(), study.key(), outcomes, trial_name(absent)),
                      UsageError);
  }
}

}  // namespace
}  // namespace touchtrial
