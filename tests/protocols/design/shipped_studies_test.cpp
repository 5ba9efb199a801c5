#include "protocols/design/schedule.hpp"
#include "protocols/design/study.hpp"
#include "support/catch.hpp"

#include <filesystem>

namespace touchtrial {
namespace {

const std::filesystem::path kConfig = std::filesystem::path(TOUCHTRIAL_SOURCE_DIR) / "config";

std::vector<std::string> labels_of(const Study& study) {
  std::vector<std::string> labels;
  for (const StudyClass& study_class : study.classes) labels.push_back(study_class.label);
  return labels;
}

}  // namespace

TEST_CASE("the classification study is the paper's: five textures, 25 trials, one method") {
  const Study study = load_study(kConfig / "classification.json");
  CHECK(study.name == "classification");
  CHECK(labels_of(study) == std::vector<std::string>{"bark", "cloth", "pebbles", "straw", "brick"});
  CHECK(study.presented_methods() == 1);
  CHECK(study.methods == std::vector<StudyMethod>{{{}, "adaptive"}});
  CHECK(study.scored_trials() == 25);
  CHECK(make_schedule(study, 1).presentations.size() == 25);
  CHECK(study.rendering == RenderingOptions{});
  CHECK(study.trials == TrialOptions{.practice = 5, .break_every = 10});
  CHECK(study.session == SessionPlan{});
  CHECK(study.seed == 31875542);
}

TEST_CASE("the comparison study has four objects and both methods at the same rms force") {
  const Study study = load_study(kConfig / "comparison.json");
  CHECK(study.name == "comparison");
  CHECK(study.classes.size() == 4);
  REQUIRE(study.presented_methods() == 2);
  CHECK(study.methods[0].method == Method::adaptive);
  CHECK(study.methods[1].method == Method::tv_gabor);
  CHECK(study.methods[1].tv_gabor == TvGaborOptions{});
  CHECK(study.rendering.equalise == Equalise::rms);
  CHECK(study.trials.blocks == Blocks::by_method);
  CHECK(study.scored_trials() == 40);
}

TEST_CASE("the surface study is the classification study under the other model") {
  const Study study = load_study(kConfig / "classification-surface.json");
  const Study paper = load_study(kConfig / "classification.json");
  CHECK(study.name == "classification-surface");
  CHECK(study.rendering == RenderingOptions{.model = ModelKind::surface, .gains = {}});
  CHECK(labels_of(study) == labels_of(paper));
  CHECK(study.methods == paper.methods);
  CHECK(study.trials.repeats == paper.trials.repeats);
  CHECK(study.trials.order == paper.trials.order);
  CHECK(study.seed != paper.seed);
}

TEST_CASE("the study of exemplars has the same classes with five pictures each") {
  const Study study = load_study(kConfig / "classification-exemplars.json");
  CHECK(labels_of(study) == labels_of(load_study(kConfig / "classification.json")));
  for (const StudyClass& study_class : study.classes) CHECK(study_class.images.size() == 5);
  CHECK(study.scored_trials() == 25);
}

TEST_CASE("the comparison without outlines differs from the other in its pictures alone") {
  const Study textures = load_study(kConfig / "comparison-textures.json");
  const Study objects = load_study(kConfig / "comparison.json");
  CHECK(textures.name == "comparison-textures");
  CHECK(textures.classes.size() == 4);
  CHECK(textures.methods == objects.methods);
  CHECK(textures.rendering == objects.rendering);
  CHECK(textures.scored_trials() == objects.scored_trials());
  CHECK(textures.trials.order == objects.trials.order);
  CHECK(textures.seed != objects.seed);
}

TEST_CASE("the study of controls has its adaptive method beside what could stand in for it") {
  const Study study = load_study(kConfig / "controls.json");
  CHECK(labels_of(study) == labels_of(load_study(kConfig / "comparison-textures.json")));
  REQUIRE(study.presented_methods() == 4);
  CHECK(study.methods[0] == StudyMethod{{}, "adaptive"});
  CHECK(study.methods[1].label == "adaptive-phase-scrambled");
  CHECK(study.methods[1].control == Control::phase_scrambled);
  CHECK(study.methods[2].method == Method::edge);
  CHECK(study.methods[3].method == Method::luminance);
  CHECK(study.rendering.equalise == Equalise::rms);
}

TEST_CASE("the two default studies are practised on textures of neither, and are registered") {
  for (const char* name : {"classification.json", "comparison.json"}) {
    const Study study = load_study(kConfig / name);
    CHECK(study.practice.classes.size() == 3);
    CHECK(study.practice.criterion == 4);
    CHECK(study.practice.rounds == 2);
    for (const StudyClass& learnt : study.practice.classes) {
      CHECK(std::filesystem::is_regular_file(study.folder / learnt.images.front()));
    }
    CHECK(study.registration.participants == 20);
    for (const std::string& statement :
         {study.registration.hypothesis, study.registration.stopping_rule,
          study.registration.exclusions, study.registration.primary_test}) {
      CHECK_FALSE(statement.empty());
    }
  }
}

TEST_CASE("every image of the studies that come with the program is there") {
  for (const char* name :
       {"classification.json", "classification-exemplars.json", "classification-surface.json",
        "comparison.json", "comparison-textures.json", "controls.json"}) {
    const Study study = load_study(kConfig / name);
    for (const StudyClass& study_class : study.classes) {
      for (const std::filesystem::path& image : study_class.images) {
        INFO(image.string());
        CHECK(std::filesystem::is_regular_file(study.folder / image));
      }
    }
  }
}

}  // namespace touchtrial
