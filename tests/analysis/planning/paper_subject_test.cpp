/// Checks what docs/planning.md, "Published accuracies", says about config/subjects/paper.json.
#include "analysis/planning/answer_model.hpp"
#include "analysis/planning/fit_evidence.hpp"
#include "study/prepare.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

namespace touchtrial {
namespace {

const std::filesystem::path kConfig = std::filesystem::path(TOUCHTRIAL_SOURCE_DIR) / "config";

TEST_CASE(
    "the paper's subject nearly has the paper's accuracies, and so has a very different subject") {
  const TempFolder folder;
  SeededEntropy entropy(1);
  const study::StudyKey key =
      study::make_study_key(study::load_study(kConfig / "classification.json"), entropy, true);
  study::prepare_pack(key, folder.path() / "pack");
  const simulation::SubjectModel paper =
      simulation::load_subject_model(kConfig / "subjects/paper.json");
  simulation::SubjectModel other = paper;
  other.feature_noise = 0.157;
  other.lapse = 0.08;
  other.class_bias = {
      {"bark", -2.05}, {"cloth", -3.06}, {"pebbles", 0.57}, {"straw", 2.83}, {"brick", 1.71}};
  const planning::AnswerModel model =
      planning::answer_model_of(key, engine::Pack(folder.path() / "pack"), paper,
                                {.explorations = 250, .directions = 4, .jobs = 2});
  const std::vector<planning::PictureLayout> layouts = planning::layouts_of(key.study, 20);
  const std::vector<double> published = {0.87, 0.72, 0.81, 0.91, 0.83};
  std::vector<double> cloth_for_bark;
  for (const simulation::SubjectModel& subject : {paper, other}) {
    const planning::AnswerTable table = model.answers(subject, layouts);
    cloth_for_bark.push_back(0.0);
    for (int c = 0; c < 5; ++c) {
      double right = 0.0;
      for (int layout = 0; layout < static_cast<int>(layouts.size()); ++layout) {
        right += table.answers(layout, c)[c] / static_cast<double>(layouts.size());
      }
      INFO(key.study.classes[c].label);
      // The bank is a quarter of the one of the fit: a standard error of 1.5 points.
      CHECK(right == Approx(published[c]).margin(0.05));
    }
    for (int layout = 0; layout < static_cast<int>(layouts.size()); ++layout) {
      cloth_for_bark.back() += table.answers(layout, 0)[1] / static_cast<double>(layouts.size());
    }
  }
  CHECK(cloth_for_bark[1] > 2.0 * cloth_for_bark[0]);
}

}  // namespace
}  // namespace touchtrial
