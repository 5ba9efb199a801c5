#include "protocols/identification/analysis/cues/exploration_path.hpp"

#include "analysis/fake_study.hpp"
#include "core/errors.hpp"
#include "protocols/identification/analysis/felt_fixtures.hpp"
#include "support/catch.hpp"

#include <algorithm>

namespace touchtrial {
namespace {

using namespace analysis::identification;

TEST_CASE("a path is thinned evenly, and each point has the rms force until the next") {
  record::Trace trace;
  for (int i = 0; i < 10; ++i) {
    trace.samples.push_back({{0.1 * i, 1.0, -0.5}, {i % 2 == 0 ? 3.0 : -3.0, 4.0, 0.25}});
  }
  trace.samples[8].force_n.z = 0.0;
  const std::vector<PathPoint> points = thinned_path(trace, 3);
  REQUIRE(points.size() == 3);
  CHECK(points[1].position_mm.x == Approx(0.4));
  CHECK(points[1].force_n.x == 3.0);
  CHECK(points[1].tangential_rms_n == Approx(5.0));
  CHECK(points[1].in_contact);
  CHECK_FALSE(points[2].in_contact);
  CHECK(thinned_path(trace, 10).size() == 10);
  CHECK(thinned_path(record::Trace{}, 10).empty());
  REQUIRE_THROWS_AS(thinned_path(trace, 0), std::invalid_argument);
}

TEST_CASE("a field's picture is lighter where its surface is higher, whatever its units") {
  const engine::FieldView like{.geometry = {0.2, 2, 2}};
  Plane<float> heights(2, 2, -0.1F);
  heights.at(0, 1) = heights.at(1, 1) = 0.1F;
  const GreyImage picture = field_picture(engine::TextureField(like, heights).view());
  // One standard deviation below and above the mean.
  CHECK(static_cast<int>(picture.at(0, 0)) == Approx(127.5 - 51.0).margin(1.0));
  CHECK(static_cast<int>(picture.at(1, 1)) == Approx(127.5 + 51.0).margin(1.0));
  const GreyImage flat = field_picture(engine::TextureField(like, Plane<float>(2, 2)).view());
  CHECK(flat.at(0, 0) == flat.at(1, 1));
  CHECK(field_picture(engine::FieldView{}).empty());
}

TEST_CASE("a field of spline coefficients has a picture too") {
  Plane<float> coefficients(8, 8, 0.0F);
  coefficients.at(4, 4) = 6.0F;
  const GreyImage picture = field_picture(
      engine::TextureField({.geometry = {0.2, 8, 8}, .model = engine::ModelKind::surface},
                           coefficients)
          .view());
  CHECK(picture.at(4, 4) == 255);
  CHECK(picture.at(4, 3) > picture.at(0, 0));
}

TEST_CASE("a trial's path lies over the field that was felt") {
  FakeStudy study({.with_pack = true});
  study.add({.participant = "P01",
             .answers = FakeStudy::confusing(0, 1),
             .traces = [](const study::Trial&) { return stroking_over_wave(3.0, 0.2); }});
  study.close_and_unblind();
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  const ExplorationPath path =
      exploration_path(study.store(), study.key(), outcomes, 1, 2, study.pack_folder());
  const analysis::TrialOutcome& trial = outcomes.trials.at(1);
  CHECK(path.simulated);
  CHECK(path.participant == "P01");
  CHECK(path.class_label == outcomes.classes[trial.stimulus.class_index]);
  CHECK(path.method == "adaptive");
  CHECK(path.answered_right == trial.correct());
  CHECK(path.duration_s == Approx(3.0));
  CHECK(path.points.size() == 1500);
  CHECK(path.points[100].position_mm.x == Approx(25.0).margin(0.002));
  CHECK(path.points[100].in_contact);
  CHECK_FALSE(path.texture.source.empty());
  CHECK(path.texture.grey.width() == 2);
  REQUIRE_THROWS_AS(exploration_path(study.store(), study.key(), outcomes, 1, 99), StoreError);
  const ExplorationPath bare = exploration_path(study.store(), study.key(), outcomes, 1, 2);
  CHECK(bare.texture.grey.empty());
  CHECK(bare.points.size() == 1500);
}

record::Trace wave(const study::Trial& /*shown*/) {
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
  FakeStudy study(study::identification::comparison());
  study.add(
      {.participant = "P01", .enrolment = 1, .complete = false, .stop_after = 1, .traces = wave});
  study.add({.participant = "P02", .enrolment = 2, .traces = wave});
  study.close_and_unblind();
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  const auto paths = first_explorations(study.store(), study.key(), outcomes);
  REQUIRE(paths.size() == 2);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    CHECK(paths[i].method == outcomes.methods[i]);
    CHECK(paths[i].participant == "P02");
  }
  CHECK(std::min(paths[0].trial, paths[1].trial) == 1);
}

TEST_CASE("a named trial is drawn whether it counts or not, and an unknown one is refused") {
  FakeStudy study(study::identification::classification());
  study.add({.participant = "P01", .traces = wave});
  study.close_and_unblind();
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  const ExplorationPath path =
      find_exploration(study.store(), study.key(), outcomes, trial_name("P01:3"));
  CHECK(path.participant == "P01");
  CHECK(path.trial == 3);
  for (const std::string absent : {"P01:99", "P02:1"}) {
    REQUIRE_THROWS_AS(find_exploration(study.store(), study.key(), outcomes, trial_name(absent)),
                      UsageError);
  }
}

}  // namespace

}  // namespace touchtrial
