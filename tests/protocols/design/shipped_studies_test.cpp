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
  CHECK(study.methods == std::vector<ExtractionOptions>(1));
  CHECK(study.scored_trials() == 25);
  CHECK(make_schedule(study, 1).presentations.size() == 25);
  CHECK(study.rendering == RenderingOptions{});
  CHECK(study.trials == TrialOptions{});
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

TEST_CASE("every image of the studies that come with the program is there") {
  for (const char* name : {"classification.json", "comparison.json"}) {
    const Study study = load_study(kConfig / name);
    for (const StudyClass& study_class : study.classes) {
      INFO(study_class.images[0].string());
      CHECK(std::filesystem::is_regular_file(study.folder / study_class.images[0]));
    }
  }
}

}  // namespace touchtrial
