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

store::Trace wave(const design::Presentation& /*shown*/) {
  return stroking_over_wave(3.0, 0.2);
}

TEST_CASE("a trial's name is a participant's, a colon and a number from 1") {
  CHECK(analysis::trial_name("P01:12").participant == "P01");
  CHECK(analysis::trial_name("P01:12").trial == 12);
  CHECK(analysis::trial_name("a:b:3").participant == "a:b");
  for (const std::string wrong :
       {"", "P01", "P01:", ":3", "P01:0", "P01:-1", "P01:3x", "P01: 3", "P01:99999999999"}) {
    INFO(wrong);
    REQUIRE_THROWS_AS(analysis::trial_name(wrong), UsageError);
  }
}

TEST_CASE("without a choice each method's first counted trial is drawn") {
  FakeStudy study(design::Protocol::comparison);
  study.add({.participant = "P01",
             .enrolment = 1,
             .answers = FakeStudy::always_right(),
             .complete = false,
             .stop_after = 1,
             .traces = wave});
  study.add(
      {.participant = "P02", .enrolment = 2, .answers = FakeStudy::always_right(), .traces = wave});
  study.close_and_unblind();
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  const auto paths = analysis::first_explorations(study.store(), study.key(), outcomes);
  REQUIRE(paths.size() == 2);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    CHECK(paths[i].method == outcomes.methods[i]);
    CHECK(paths[i].participant == "P02");
  }
  CHECK(std::min(paths[0].trial, paths[1].trial) == 1);
}

TEST_CASE("a named trial is drawn, counted or not, and one that is not there is refused") {
  FakeStudy study(design::Protocol::classification);
  study.add({.participant = "P01", .answers = FakeStudy::always_right(), .traces = wave});
  study.close_and_unblind();
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  const analysis::ExplorationPath path = analysis::exploration_named(
      study.store(), study.key(), outcomes, analysis::trial_name("P01:3"));
  CHECK(path.participant == "P01");
  CHECK(path.trial == 3);
  for (const std::string absent : {"P01:99", "P02:1"}) {
    REQUIRE_THROWS_AS(analysis::exploration_named(study.store(), study.key(), outcomes,
                                                  analysis::trial_name(absent)),
                      UsageError);
  }
}

}  // namespace
}  // namespace touchtrial
