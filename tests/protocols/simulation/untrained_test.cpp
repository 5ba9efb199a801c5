/// People who match pictures to feelings without training, on the stimuli that come with the
/// program.
#include "protocols/design/prepare.hpp"
#include "protocols/simulation/felt_bank.hpp"
#include "protocols/simulation/felt_decision.hpp"
#include "protocols/simulation/own_knowledge.hpp"
#include "protocols/simulation/pictured_knowledge.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace touchtrial {
namespace {

constexpr int kPassesFelt = 40;

/// The default study, felt forty times.
struct FeltDefaultStudy {
  FeltDefaultStudy() : key(make_key()) {
    design::prepare_pack(key, folder.path() / "default.sim.pack");
    pack.emplace(folder.path() / "default.sim.pack");
    source.emplace(*pack, key.study.rendering);
    fields.emplace(key, *source);
    subject.feature_noise = 0.28;
    bank.emplace(*fields, key.study, subject,
                 simulation::FeltBankOptions{.explorations = kPassesFelt, .seed = 2, .jobs = 2});
  }

  [[nodiscard]] static design::StudyKey make_key() {
    const std::filesystem::path config = std::filesystem::path(TOUCHTRIAL_SOURCE_DIR) / "config";
    SeededEntropy entropy(1);
    return design::make_study_key(design::load_study(config / "classification.json"), entropy,
                                  true);
  }

  /// The share of right answers of ten people.
  [[nodiscard]] double accuracy_with(
      const std::shared_ptr<const simulation::FeltKnowledge>& learnt) const {
    std::vector<std::string> labels;
    for (const design::StudyClass& one : key.study.classes) labels.push_back(one.label);
    int right = 0;
    int all = 0;
    for (int number = 1; number <= 10; ++number) {
      const simulation::Individual individual(subject, 1, number);
      const auto known = simulation::remembered(learnt, subject, 1, number);
      const simulation::FeltDecision decision(individual, *known);
      const simulation::SeenPictures pictures =
          simulation::see(labels, subject, individual, *known);
      std::uint64_t nth = 0;
      for (int place = 0; place < bank->stimuli(); ++place) {
        for (const engine::FeltFeatures& felt : bank->felt(place)) {
          RandomStream random =
              simulation::stream_of_trial(1, simulation::kAnswerPurpose, number, ++nth);
          const int answered = decision.answer(felt, pictures, random).position;
          right += answered == bank->stimulus(place).class_index ? 1 : 0;
          ++all;
        }
      }
    }
    return static_cast<double>(right) / all;
  }

  TempFolder folder;
  design::StudyKey key;
  std::optional<engine::Pack> pack;
  std::optional<session::StimulusSource> source;
  std::optional<simulation::LabelledFields> fields;
  simulation::SubjectModel subject;
  std::optional<simulation::FeltBank> bank;
};

TEST_CASE("the untrained are better than chance and worse than the trained") {
  FeltDefaultStudy study;
  const auto accuracy = [&](simulation::Training training, double mapping_noise) {
    study.subject.training = training;
    study.subject.mapping_noise = mapping_noise;
    return study.accuracy_with(
        simulation::learn(*study.fields, study.key.study, study.subject, 1, 2));
  };
  const double trained = accuracy(simulation::Training::shared, 0.0);
  const double untrained = accuracy(simulation::Training::none, 0.0);
  const double unsure = accuracy(simulation::Training::none, 0.3);
  // 2,000 answers each: standard errors of 1 point, and those of ten people's mappings of 3.
  CHECK(trained > untrained + 0.03);
  CHECK(untrained > unsure + 0.03);
  CHECK(unsure > 0.25);
  CHECK(accuracy(simulation::Training::none, 10.0) == Approx(0.2).margin(0.12));
}

TEST_CASE("pictures that have nothing to do with the textures leave the untrained at chance") {
  // Each picture stands in turn for each class, so that on average none belongs to its texture.
  FeltDefaultStudy study;
  const simulation::FeltKnowledge felt =
      simulation::learn_by_feeling(*study.fields, study.subject, 3.3, 1, 2);
  const simulation::PicturedFeatures pictures = simulation::look_at_pictures(study.key.study);
  const std::size_t classes = study.key.study.classes.size();
  double sum = 0.0;
  for (std::size_t turn = 0; turn < classes; ++turn) {
    simulation::PicturedFeatures shuffled;
    for (std::size_t i = 0; i < classes; ++i) {
      shuffled[study.key.study.classes[i].label] =
          pictures.at(study.key.study.classes[(i + turn) % classes].label);
    }
    const double accuracy = study.accuracy_with(std::make_shared<const simulation::FeltKnowledge>(
        simulation::expected_from_pictures(felt, shuffled)));
    sum += accuracy;
    if (turn == 0) CHECK(accuracy > 0.4);
  }
  CHECK(sum / static_cast<double>(classes) == Approx(0.2).margin(0.01));
}

}  // namespace
}  // namespace touchtrial
