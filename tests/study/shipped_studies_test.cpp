#include "study/study_examples.hpp"
#include "support/catch.hpp"

namespace touchtrial {
namespace {

const std::filesystem::path kConfig = std::filesystem::path(TOUCHTRIAL_SOURCE_DIR) / "config";

std::vector<std::string> labels_of(const study::Study& study) {
  std::vector<std::string> labels;
  for (const study::StudyClass& study_class : study.classes) labels.push_back(study_class.label);
  return labels;
}

}  // namespace

TEST_CASE("the classification study is the paper's: five textures, 25 trials, one method") {
  const study::Study study = study::load_study(kConfig / "classification.json");
  CHECK(study.name == "classification");
  CHECK(labels_of(study) == std::vector<std::string>{"bark", "cloth", "pebbles", "straw", "brick"});
  CHECK(study.presented_methods() == 1);
  CHECK(study.methods == std::vector<study::StudyMethod>{{{}, "adaptive"}});
  CHECK(study.scored_trials() == 25);
  CHECK(schedule_of(study, 1).trials.size() == 25);
  CHECK(study.rendering == engine::RenderingOptions{});
  CHECK(study.trials == study::TrialOptions{.practice = 5, .break_every = 10});
  CHECK(study.session == study::SessionPlan{});
  CHECK(study.seed == 31875542);
}

TEST_CASE("the comparison study has four objects and both methods at the same rms force") {
  const study::Study study = study::load_study(kConfig / "comparison.json");
  CHECK(study.name == "comparison");
  CHECK(study.classes.size() == 4);
  REQUIRE(study.presented_methods() == 2);
  CHECK(study.methods[0].method == engine::Method::adaptive);
  CHECK(study.methods[1].method == engine::Method::tv_gabor);
  CHECK(study.methods[1].tv_gabor == engine::TvGaborOptions{});
  CHECK(study.rendering.equalise == engine::Equalise::rms);
  CHECK(study.trials.blocks == study::Blocks::mixed);
  CHECK(study.scored_trials() == 40);
}

TEST_CASE("studies that compare methods mix them, so that their test needs no periods") {
  for (const char* name : {"comparison.json", "comparison-textures.json", "controls.json"}) {
    CHECK(study::load_study(kConfig / name).trials.blocks == study::Blocks::mixed);
  }
  const study::Study study = study::load_study(kConfig / "comparison.json");
  CHECK(study.registration.analysis.value().test == study::RegisteredTest::sign_flip);
}

TEST_CASE("the surface study is the classification study under the other model") {
  const study::Study study = study::load_study(kConfig / "classification-surface.json");
  const study::Study paper = study::load_study(kConfig / "classification.json");
  CHECK(study.name == "classification-surface");
  CHECK(study.rendering ==
        engine::RenderingOptions{.model = engine::ModelKind::surface, .gains = {}});
  CHECK(labels_of(study) == labels_of(paper));
  CHECK(study.methods == paper.methods);
  CHECK(study.trials.repeats == paper.trials.repeats);
  CHECK(study.trials.order == paper.trials.order);
  CHECK(study.seed != paper.seed);
}

TEST_CASE("the study of exemplars has the same classes with five pictures each") {
  const study::Study study = study::load_study(kConfig / "classification-exemplars.json");
  CHECK(labels_of(study) == labels_of(study::load_study(kConfig / "classification.json")));
  for (const study::StudyClass& study_class : study.classes) CHECK(study_class.images.size() == 5);
  CHECK(study.scored_trials() == 25);
}

TEST_CASE("the comparison without outlines differs from the other in its pictures alone") {
  const study::Study textures = study::load_study(kConfig / "comparison-textures.json");
  const study::Study objects = study::load_study(kConfig / "comparison.json");
  CHECK(textures.name == "comparison-textures");
  CHECK(textures.classes.size() == 4);
  CHECK(textures.methods == objects.methods);
  CHECK(textures.rendering == objects.rendering);
  CHECK(textures.scored_trials() == objects.scored_trials());
  CHECK(textures.trials.order == objects.trials.order);
  CHECK(textures.seed != objects.seed);
}

TEST_CASE("the study of controls compares the adaptive method with a control and other methods") {
  const study::Study study = study::load_study(kConfig / "controls.json");
  CHECK(labels_of(study) == labels_of(study::load_study(kConfig / "comparison-textures.json")));
  REQUIRE(study.presented_methods() == 4);
  CHECK(study.methods[0] == study::StudyMethod{{}, "adaptive"});
  CHECK(study.methods[1].label == "adaptive-phase-scrambled");
  CHECK(study.methods[1].control == engine::Control::phase_scrambled);
  CHECK(study.methods[2].method == engine::Method::edge);
  CHECK(study.methods[3].method == engine::Method::luminance);
  CHECK(study.rendering.equalise == engine::Equalise::rms);
}

TEST_CASE("the two default studies are practised on textures of neither, and are registered") {
  for (const char* name : {"classification.json", "comparison.json"}) {
    const study::Study study = study::load_study(kConfig / name);
    CHECK(study.practice.classes.size() == 3);
    CHECK(study.practice.criterion == 4);
    CHECK(study.practice.rounds == 2);
    for (const study::StudyClass& learnt : study.practice.classes) {
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
    const study::Study study = study::load_study(kConfig / name);
    for (const study::StudyClass& study_class : study.classes) {
      for (const std::filesystem::path& image : study_class.images) {
        INFO(image.string());
        CHECK(std::filesystem::is_regular_file(study.folder / image));
      }
    }
  }
}

}  // namespace touchtrial
