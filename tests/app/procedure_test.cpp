// The commands for studies of thresholds: procedure, and power.
#include "app/study_folder.hpp"
#include "support/catch.hpp"

using namespace touchtrial;

namespace {

/// A study of one or two thresholds, short enough to be simulated in a test.
struct ThresholdFolder : StudyFolder {
  explicit ThresholdFolder(int classes = 1) {
    json study = study_of("classification");
    study["classes"].erase(study["classes"].begin() + classes, study["classes"].end());
    study.update(json::parse(R"({"protocol": "threshold",
      "trials": {"explore_limit_s": 6.0,
                 "validity": {"exploring_s": 1.0, "contact_s": 1.0, "path_mm": 20.0}},
      "threshold": {"task": "detection", "interval_s": 0.4, "trials": 6,
                    "levels": {"from": -40, "to": 0, "step": 4}}})"));
    replace_file(path() / "detection.json", study.dump());
    replace_file(path() / "quick.json", R"({"feature_noise": 0.05, "training_passes": 2})");
  }

  [[nodiscard]] ProgramResult procedure(const std::string& options) const {
    return type("procedure @detection.json " + options);
  }
  [[nodiscard]] ProgramResult power(const std::string& options) const {
    return type("power @detection.json --subject @quick.json --runs 50 " + options);
  }
  [[nodiscard]] ProgramResult procedure_of(const std::string& answers) const {
    return procedure("--answers '" + answers + "'");
  }
};

}  // namespace

TEST_CASE("procedure shows the levels for a list of answers") {
  const ThresholdFolder study;
  const ProgramResult first = succeeded(study.procedure_of(""));
  CHECK(json::parse(first.output).at("levels").size() == 1);
  const ProgramResult more = succeeded(study.procedure("--answers 1,0,1 --json"));
  const json walk = json::parse(more.output);
  CHECK(walk.at("track") == "granite");
  CHECK(walk.at("answers") == json::array({1, 0, 1}));
  CHECK(walk.at("levels").size() == 4);
  CHECK(walk.at("posterior").size() == 4);
  CHECK(walk.at("levels").at(0) == json::parse(first.output).at("levels").at(0));
}

TEST_CASE("procedure refuses invalid answers, too many answers, and other studies") {
  const ThresholdFolder study;
  check_refused(study.procedure_of("1,2"), 2, {"--answers", "\"2\"", "1"});
  check_refused(study.procedure_of("1,"), 2, {"--answers"});
  check_refused(study.procedure_of("1,1,1,1,1,1,1"), 2, {"7 answers", "6 trials"});
  check_refused(study.procedure("--answers 1 --track 2"), 2, {"--track", "has 1 track"});
  check_refused(study.procedure(""), 2, {"--answers"});
  check_refused(study.type("procedure @cloths.json --answers 1"), 2,
                {"cloths.json", "classification"});
}

TEST_CASE("power plans the thresholds of a study, the same with any number of threads") {
  const ThresholdFolder study(2);
  const std::string plan = "--pool 10 --participants 4,6 --trials 4,6 --width 3 --json --jobs ";
  const ProgramResult result = succeeded(study.power(plan + "2"));
  CHECK(study.power(plan + "1").output == result.output);
  const json report = json::parse(result.output);
  CHECK(report.at("simulated") == true);
  REQUIRE(report.at("trials").size() == 2);
  const json& last = report.at("trials").at(1);
  CHECK(last.at("trials") == 6);
  CHECK(last.at("tracks") == 20);
  REQUIRE(last.at("sizes").size() == 2);
  const json& size = last.at("sizes").at(1);
  CHECK(size.at("participants") == 6);
  CHECK(size.at("thresholds").at(0).at("within").at("samples") == 50);
  CHECK(size.at("difference").at("power").at("samples") == 50);
  const ProgramResult text = study.power("--pool 10 --participants 4");
  CHECK_THAT(text.output,
             Catch::Matchers::StartsWith("simulated on: ") && holds_text("granite less linen"));
}

TEST_CASE("power refuses options of other protocols, and impossible ones of thresholds") {
  const ThresholdFolder study;
  check_refused(study.power("--margin 0.1"), 2, {"--margin"});
  check_refused(study.power("--explorations 10"), 2, {"--explorations"});
  check_refused(study.power("--difference 1,2"), 2, {"--difference", "1 threshold"});
  check_refused(study.power("--difference 1"), 2, {"--difference"});
  check_refused(study.power("--trials 6,6"), 2, {"--trials"});
  check_refused(study.power("--trials 6,x"), 2, {"--trials", "'x'"});
  check_refused(study.power("--width 0"), 2, {"--width"});
  check_refused(study.type("power @cloths.json --width 1"), 2, {"--width", "threshold"});
}
