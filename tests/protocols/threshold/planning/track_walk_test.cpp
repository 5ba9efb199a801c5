// What `touchtrial procedure` shows of one track.
#include "protocols/threshold/planning/track_walk.hpp"

#include "analysis/planning/planner.hpp"
#include "core/errors.hpp"
#include "protocols/procedures/posterior.hpp"
#include "protocols/threshold/study/threshold.hpp"
#include "protocols/threshold/threshold_study.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

using namespace touchtrial;
using namespace touchtrial::planning;
using namespace touchtrial::planning::threshold;

namespace {

const std::string kOneStandard =
    R"("task": "discrimination", "interval_s": 0.5, "trials": 6,
       "levels": {"from": -30, "to": -6, "step": 2}, "standards": [-12])";

/// One class, so that tracks are few.
study::Study walked_study(const std::string& section) {
  study::Study study = TinyStudy(threshold_options(kTinyDetection)).key().study;
  study.classes.resize(1);
  const TinyStudy other(threshold_options(section));
  study.task = other.key().study.task;
  return study;
}

}  // namespace

TEST_CASE("a walk has one level more than answers until the track ends") {
  const study::Study study = walked_study(kTinyDetection);
  CHECK(replay_track(study, 1, {}).levels.size() == 1);
  CHECK(replay_track(study, 1, {true, false, true}).levels.size() == 4);
  const TrackWalk whole = replay_track(study, 1, std::vector<bool>(8, true));
  CHECK(whole.levels.size() == 8);
  CHECK(whole.posteriors.size() == 9);
  CHECK_THROWS_WITH(replay_track(study, 1, std::vector<bool>(9, true)), names("--answers 9 8"));
}

TEST_CASE("a walk believes what a posterior of its levels and answers believes") {
  const study::Study study = walked_study(kTinyDetection);
  const std::vector<bool> answers = {true, true, false, true, false, false, true};
  const TrackWalk walk = replay_track(study, 1, answers);
  const auto& settings = study::threshold::options_of(study).track;
  procedures::Posterior posterior(settings.levels, settings.grid);
  for (std::size_t i = 0; i <= answers.size(); ++i) {
    INFO(i);
    CHECK(walk.levels[i] == settings.levels[posterior.best_level(procedures::Nuisance::none)]);
    CHECK(walk.posteriors[i].threshold.mean == procedures::mean_of(posterior.threshold()));
    CHECK(walk.posteriors[i].slope.sd == procedures::sd_of(posterior.slope()));
    CHECK(walk.posteriors[i].lapse.mode == posterior.mode().lapse);
    if (i == answers.size()) break;
    posterior.observe(posterior.best_level(procedures::Nuisance::none), answers[i]);
  }
}

TEST_CASE("a walk names its track, and there is no other") {
  const study::Study one = walked_study(kOneStandard);
  study::threshold::ThresholdOptions options = study::threshold::options_of(one);
  options.standards = {-12.0, -9.0};
  options.tracks_each = 2;
  const study::Study study = study::threshold::with_options(one, options);
  CHECK_THAT(replay_track(study, 1, {}).words, names("-12"));
  CHECK_THAT(replay_track(study, 2, {}).words, names("-12"));
  CHECK_THAT(replay_track(study, 4, {}).words, names("-9"));
  CHECK_THROWS_WITH(replay_track(study, 5, {}), names("--track 5"));
  CHECK_THROWS_WITH(replay_track(study, 0, {}), names("--track 0 1 4"));
}

TEST_CASE("constant stimuli are replay_track in the same order whenever they are asked for") {
  const study::Study study = walked_study(
      R"("task": "detection", "procedure": "constant-stimuli", "trials": 20,
         "levels": {"from": -20, "to": -2, "step": 2})");
  const std::vector<bool> right(20, true);
  const std::vector<bool> wrong(20, false);
  CHECK(replay_track(study, 1, right).levels == replay_track(study, 1, wrong).levels);
}

TEST_CASE("same or different has levels and no posteriors") {
  const study::Study study = walked_study(
      R"("task": "discrimination", "question": "same-different", "trials": 4,
         "procedure": "constant-stimuli", "levels": [-12, -6], "standards": [-6])");
  const TrackWalk walk = replay_track(study, 1, {true, false});
  CHECK(walk.levels.size() == 3);
  CHECK(walk.posteriors.empty());
  const auto document = nlohmann::json::parse(track_walk_json(walk));
  CHECK(document.at("posterior").is_null());
  CHECK(document.at("grid").is_null());
}

TEST_CASE("the document of a walk has grid, levels and posteriors") {
  const TrackWalk walk = replay_track(walked_study(kTinyDetection), 1, {true, false});
  const auto document = nlohmann::json::parse(track_walk_json(walk));
  CHECK(document.at("procedure") == "quest-plus");
  CHECK(document.at("trials") == 8);
  CHECK(document.at("answers") == nlohmann::json::array({1, 0}));
  CHECK(document.at("levels").size() == 3);
  CHECK(document.at("posterior").size() == 3);
  const auto& grid = document.at("grid");
  CHECK(grid.at("guess") == nlohmann::json::array({0.5}));
  for (const char* parameter : {"threshold", "slope", "lapse"}) {
    double sum = 0.0;
    for (const double weight : grid.at("prior").at(parameter)) sum += weight;
    CHECK(grid.at("prior").at(parameter).size() == grid.at(parameter).size());
    CHECK(sum == Approx(1.0));
  }
}

TEST_CASE("a study of another protocol has no procedure to walk") {
  const study::Study study = TinyStudy().key().study;
  const Planner& planner = planner_of(study, "`procedure`");
  CHECK_THROWS_WITH(planner.procedure(study, 1, {}), names("classification config/detection.json"));
  CHECK_THROWS_AS(planner.procedure(study, 1, {}), UsageError);
}
