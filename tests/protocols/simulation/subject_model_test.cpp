#include "protocols/simulation/subject_model.hpp"

#include "core/errors.hpp"
#include "support/catch.hpp"
#include "support/refusal.hpp"

#include <set>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using nlohmann::json;

/// A list of lists, which braces alone would make an object.
json pairs(const std::vector<std::vector<std::string>>& lists) {
  return lists;
}

const std::filesystem::path kRoot = TOUCHTRIAL_SOURCE_DIR;

simulation::SubjectModel parsed(const json& subject) {
  return simulation::parse_subject_model(subject.dump(), "subject.json");
}

/// The error that a subject is refused with; empty if it is accepted.
std::string refusal(const json& subject) {
  return message_of<StudyError>([&] { return parsed(subject); });
}

study::Study study_of(const std::vector<std::string>& labels) {
  study::Study study;
  for (const std::string& label : labels) study.classes.push_back({label, {}});
  return study;
}

TEST_CASE("a subject file is refused with the place and a remedy") {
  CHECK_THAT(refusal({{"label_swap", pairs({{"a", "b"}, {"b", "c"}})}}),
             holds_text("/label_swap/1/0"));
  CHECK_THAT(refusal({{"label_swap", pairs({{"a"}})}}), holds_text("/label_swap/0"));
  CHECK_THAT(refusal({{"slowest_mm_s", 200}}), holds_text("/slowest_mm_s"));
  CHECK_THAT(refusal({{"fastest_mm_s", 20}}), holds_text("/fastest_mm_s"));
  CHECK_THAT(refusal({{"thought", {{"easy_s", 3}, {"hard_s", 2}}}}), holds_text("/thought"));
  CHECK_THAT(refusal({{"thought", {{"shift_s", 3}, {"longest_s", 2}}}}),
             holds_text("/thought") && holds_text("longest_s"));
  CHECK_THAT(refusal(json::array()), holds_text("subject.json"));
  CHECK_THROWS_AS(simulation::parse_subject_model("{", "subject.json"), StudyError);
  CHECK_THROWS_AS(simulation::load_subject_model("no/such/subject.json"), FileError);
}

TEST_CASE("a label that the study does not have is refused with its place") {
  const study::Study study = study_of({"bark", "straw", "brick"});
  CHECK_NOTHROW(parsed({{"label_swap", pairs({{"bark", "straw"}})}}).check_labels(study));
  CHECK_THROWS_WITH(parsed({{"label_swap", pairs({{"bark", "strew"}})}}).check_labels(study),
                    holds_text("subject.json: /label_swap/0/1") && holds_text("straw"));
  const json biased = {{"bias", {{"classes", {{{"label", "sand"}, {"log_odds", 1}}}}}}};
  CHECK_THROWS_WITH(parsed(biased).check_labels(study), holds_text("/bias/classes/0/label"));
}

TEST_CASE("the subject files that come with the program are accepted") {
  const auto folder = kRoot / "config" / "subjects";
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    CHECK_NOTHROW(simulation::load_subject_model(entry.path()));
    names.insert(entry.path().filename().string());
  }
  CHECK(names.contains("default.json"));
  CHECK(simulation::load_subject_model(folder / "ideal.json").feature_noise == 0.0);
  CHECK(simulation::load_subject_model(folder / "swapped.json").label_swap.size() == 1);
}

TEST_CASE("every key of a subject file is read, and written back to the last digit") {
  const json file = json::parse(R"({
    "sense": "tan_1994", "threshold_spread_db": 2.5, "feature_noise": 0.30000000000000004,
    "common_noise": 0.35, "feature_noise_spread": 0.3333333333333333, "lapse": 0.02,
    "lapse_spread": 0.7,
    "bias": {"position": -1.5, "position_spread": 0.25, "class_spread": 0.125,
             "classes": [{"label": "bark \"rough\"", "log_odds": -2.1},
                         {"label": "Ton", "log_odds": 0.001}]},
    "label_swap": [["bark \"rough\"", "Ton"]], "explore_s": 4.25, "push_n": 0.9,
    "slowest_mm_s": 20, "fastest_mm_s": 70, "hand": {"model": "stylus_grip", "spread": 0.45},
    "training_passes": 3, "training": "own", "memory_noise": 0.1,
    "learning": {"factor": 1.7, "trials": 33, "forgotten": 0.3, "spread": 0.2},
    "period_noise_spread": 0.15,
    "serial": {"answer": 0.4, "answer_spread": 0.6, "stimulus": -0.3, "stimulus_spread": 0.05},
    "fatigue": {"noise_per_min": 0.03, "lapse_per_min": 0.11, "recovered": 0.65},
    "thought": {"shift_s": 0.21, "easy_s": 0.75, "hard_s": 2.25, "margin": 3.5, "spread": 0.42,
                "longest_s": 29},
    "given_function": {"threshold": -18, "spread": 2, "standard_step": 1.5,
                       "standard_spread": 0.5, "slope": 3.75, "lapse": 0.024}})");
  simulation::SubjectModel model;
  model.sense = engine::ThresholdCurve::tan_1994;
  model.threshold_spread_db = 2.5;
  model.feature_noise = 0.1 + 0.2;
  model.common_noise = 0.35;
  model.feature_noise_spread = 1.0 / 3.0;
  model.lapse = 0.02;
  model.lapse_spread = 0.7;
  model.position_bias = -1.5;
  model.position_bias_spread = 0.25;
  model.class_bias = {{"bark \"rough\"", -2.1}, {"Ton", 1e-3}};
  model.class_bias_spread = 0.125;
  model.label_swap = {{"bark \"rough\"", "Ton"}};
  model.explore_s = 4.25;
  model.push_n = 0.9;
  model.slowest_mm_s = 20.0;
  model.fastest_mm_s = 70.0;
  model.hand = device::HandKind::stylus_grip;
  model.hand_spread = 0.45;
  model.training_passes = 3;
  model.training = simulation::Training::own;
  model.memory_noise = 0.1;
  model.learning = {.factor = 1.7, .trials = 33.0, .forgotten = 0.3, .spread = 0.2};
  model.period_noise_spread = 0.15;
  model.serial = {.answer = 0.4, .answer_spread = 0.6, .stimulus = -0.3, .stimulus_spread = 0.05};
  model.fatigue = {.noise_per_min = 0.03, .lapse_per_min = 0.11, .recovered = 0.65};
  model.thought = simulation::ThoughtTime{.shift_s = 0.21,
                                          .easy_s = 0.75,
                                          .hard_s = 2.25,
                                          .margin = 3.5,
                                          .spread = 0.42,
                                          .max_s = 29.0};
  model.given_function = simulation::GivenFunction{-18.0, 2.0, 3.75, 0.024, 1.5, 0.5};
  const std::string written = simulation::subject_model_json(model);
  CHECK(json::parse(written) == file);
  CHECK(simulation::subject_model_json(parsed(file)) == written);
}

}  // namespace
}  // namespace touchtrial
