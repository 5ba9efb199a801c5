/// The studies, stimuli and subjects that come with the program, taken together.
#include "protocols/session/commitment.hpp"
#include "protocols/simulation/confusion_of.hpp"
#include "protocols/simulation/simulation.hpp"
#include "study/prepare.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

namespace touchtrial {
namespace {

const std::filesystem::path kConfig = std::filesystem::path(TOUCHTRIAL_SOURCE_DIR) / "config";

/// A study that comes with the program, prepared.
class DefaultStudy {
 public:
  explicit DefaultStudy(const char* study_file = "classification.json")
      : key_(make_key(study_file)) {
    study::prepare_pack(key_, folder_.path() / "default.sim.pack");
  }

  [[nodiscard]] double accuracy_of(const char* subject_file, int participants) const {
    const engine::Pack pack(folder_.path() / "default.sim.pack");
    const simulation::SubjectModel subject =
        simulation::load_subject_model(kConfig / "subjects" / subject_file);
    record::StudyStore store = record::StudyStore::create(
        folder_.path() / (std::string(subject_file) + ".db"),
        session::commitment_of(key_, pack, true, false), {}, key_.signer());
    const simulation::SimulationReport report = simulation::simulate_study(
        key_, pack, subject, {.participants = participants, .seed = 1, .jobs = 2}, store);
    CHECK(report.invalid_trials == 0);
    const Confusion confusion = confusion_of(store, key_);
    return static_cast<double>(correct_of(confusion)) / report.presentations;
  }

 private:
  [[nodiscard]] static study::StudyKey make_key(const char* study_file) {
    SeededEntropy entropy(1);
    return study::make_study_key(study::load_study(kConfig / study_file), entropy, true);
  }

  TempFolder folder_;
  study::StudyKey key_;
};

TEST_CASE("who feels forces is right in the default study as often as published of people") {
  const double accuracy = DefaultStudy().accuracy_of("flat.json", 20);
  CHECK(accuracy >= 0.70);
  CHECK(accuracy <= 0.95);
}

TEST_CASE("who feels by published thresholds is right less often, and far from guessing") {
  const DefaultStudy study;
  const double accuracy = study.accuracy_of("default.json", 20);
  CHECK(accuracy < study.accuracy_of("flat.json", 20));
  CHECK(accuracy > 0.5);
}

TEST_CASE("pessimistic people are worse than the default ones, and better than chance") {
  const DefaultStudy study;
  const double accuracy = study.accuracy_of("pessimistic.json", 20);
  CHECK(accuracy < study.accuracy_of("default.json", 20) - 0.05);
  CHECK(accuracy > 0.25);
}

TEST_CASE("the surface model's textures are told apart about as well as the paper's") {
  const DefaultStudy surface("classification-surface.json");
  const double accuracy = surface.accuracy_of("default.json", 10);
  CHECK(accuracy >= 0.70);
  CHECK(accuracy <= 0.95);
  CHECK(surface.accuracy_of("ideal.json", 4) >= 0.98);
}

TEST_CASE("without noise the default study is answered almost without errors") {
  CHECK(DefaultStudy().accuracy_of("ideal.json", 4) >= 0.98);
}

TEST_CASE("the swapped subject confuses two of the default study's classes and no other") {
  CHECK(DefaultStudy().accuracy_of("swapped.json", 4) == Approx(0.6).margin(0.02));
}

}  // namespace
}  // namespace touchtrial
