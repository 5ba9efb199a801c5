#include "protocols/simulation/subject_model.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "support/catch.hpp"

#include <set>
#include <utility>

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
  try {
    static_cast<void>(parsed(subject));
  } catch (const StudyError& error) {
    return error.what();
  }
  return "";
}

study::Study study_of(const std::vector<std::string>& labels) {
  study::Study study;
  for (const std::string& label : labels) study.classes.push_back({label, {}});
  return study;
}

TEST_CASE("a subject file says everything about a subject") {
  const simulation::SubjectModel subject =
      parsed({{"feature_noise", 0.3},
              {"feature_noise_spread", 0.1},
              {"lapse", 0.02},
              {"lapse_spread", 0.4},
              {"bias",
               {{"position", 0.5},
                {"position_spread", 0.25},
                {"classes", {{{"label", "bark"}, {"log_odds", -1}}}},
                {"class_spread", 0.75}}},
              {"label_swap", pairs({{"straw", "brick"}})},
              {"explore_s", 8},
              {"push_n", 0.6},
              {"slowest_mm_s", 60},
              {"fastest_mm_s", 90},
              {"hand", {{"model", "stylus_grip"}, {"spread", 0.25}}},
              {"training_passes", 3}});
  CHECK(subject.hand == device::HandKind::stylus_grip);
  CHECK(subject.hand_spread == 0.25);
  CHECK(subject.feature_noise == 0.3);
  CHECK(subject.feature_noise_spread == 0.1);
  CHECK(subject.lapse == 0.02);
  CHECK(subject.lapse_spread == 0.4);
  CHECK(subject.position_bias == 0.5);
  CHECK(subject.position_bias_spread == 0.25);
  CHECK(subject.class_bias_spread == 0.75);
  CHECK(subject.class_bias == std::vector<simulation::ClassBias>{{"bark", -1.0}});
  REQUIRE(subject.label_swap.size() == 1);
  CHECK(subject.label_swap[0] == std::pair<std::string, std::string>{"straw", "brick"});
  CHECK(subject.explore_s == 8.0);
  CHECK(subject.push_n == 0.6);
  CHECK(subject.slowest_mm_s == 60.0);
  CHECK(subject.fastest_mm_s == 90.0);
  CHECK(subject.training_passes == 3);
}

TEST_CASE("an empty subject file is an ideal subject") {
  const simulation::SubjectModel subject = parsed(json::object());
  CHECK(subject.feature_noise == 0.0);
  CHECK(subject.lapse == 0.0);
  CHECK(subject.explore_s == 10.0);
  CHECK(subject.push_n == 0.7);
  CHECK(subject.hand == device::HandKind::point_mass);
  CHECK(subject.hand_spread == 0.0);
}

TEST_CASE("a subject file is refused with the place and a remedy") {
  CHECK_THAT(refusal({{"webber", 0.3}}),
             holds_text("subject.json: /webber") && holds_text("feature_noise"));
  CHECK_THAT(refusal({{"lapse", 1.5}}), holds_text("/lapse"));
  CHECK_THAT(refusal({{"push_n", "hard"}}), holds_text("/push_n"));
  CHECK_THAT(refusal({{"bias", {{"positon", 1}}}}), holds_text("/bias/positon"));
  CHECK_THAT(refusal({{"hand", {{"spread", 1.5}}}}), holds_text("/hand/spread"));
  CHECK_THAT(refusal({{"hand", {{"model", "stylus_gripp"}}}}),
             holds_text("/hand/model") && holds_text("stylus_grip"));
  CHECK_THAT(refusal({{"label_swap", pairs({{"a", "b"}, {"b", "c"}})}}),
             holds_text("/label_swap/1/0"));
  CHECK_THAT(refusal({{"label_swap", pairs({{"a"}})}}), holds_text("/label_swap/0"));
  CHECK_THAT(refusal({{"slowest_mm_s", 200}}), holds_text("/slowest_mm_s"));
  CHECK_THAT(refusal({{"fastest_mm_s", 20}}), holds_text("/fastest_mm_s"));
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

/// Checks that the reader knows the keys of an object of the schema, and takes their bounds alone.
/// \param part  its name; empty: the file itself
/// \param room  beside a key, so that each bound is met alone
/// \return how many keys have bounds
int check_against_reader(const json& object, const std::string& part, const json& room = {}) {
  const auto refused = [&](const json& keys) {
    return refusal(part.empty() ? keys : json{{part, keys}});
  };
  const std::string known = refused({{"no such key at all", 1}});
  int bounded = 0;
  for (const auto& item : object.at("properties").items()) {
    CHECK_THAT(known, holds_text(item.key()));
    if (!item.value().contains("minimum")) continue;
    ++bounded;
    const auto with = [&](double number) {
      json keys = room;
      keys[item.key()] = number;
      return refused(keys);
    };
    const double low = item.value().at("minimum");
    const double high = item.value().at("maximum");
    const std::string place = (part.empty() ? "/" : "/" + part + "/") + item.key();
    CHECK(with(low).empty());
    CHECK(with(high).empty());
    CHECK_THAT(with(low - 0.001), holds_text(place));
    CHECK_THAT(with(high + 0.001), holds_text(place));
  }
  return bounded;
}

TEST_CASE("the schema of subject files and the reader know the same keys, bounds and defaults") {
  const json schema =
      json::parse(text_of(read_file(kRoot / "config" / "schema" / "subject.schema.json")));
  const json& parts = schema.at("properties");
  REQUIRE(schema.at("additionalProperties") == false);
  CHECK(check_against_reader(schema, "", {{"slowest_mm_s", 1}, {"fastest_mm_s", 1000}}) == 13);
  CHECK(check_against_reader(parts.at("bias"), "bias") == 3);
  for (const json& example : schema.at("examples")) CHECK(refusal(example).empty());
  const json room = {{"easy_s", 0.01}, {"hard_s", 60.0}, {"shift_s", 0.0}, {"longest_s", 600.0}};
  for (const auto& [part, keys] : {std::pair<std::string, int>("learning", 4),
                                   {"serial", 4},
                                   {"fatigue", 3},
                                   {"thought", 6}}) {
    INFO(part);
    const json& known = parts.at(part);
    REQUIRE(known.at("additionalProperties") == false);
    CHECK(check_against_reader(known, part, part == "thought" ? room : json()) == keys);
    const json defaults =
        json::parse(simulation::subject_model_json(parsed({{part, json::object()}}))).at(part);
    CHECK(defaults.size() == known.at("properties").size());
    for (const auto& item : known.at("properties").items()) {
      CHECK(defaults.at(item.key()) == item.value().at("default"));
    }
  }
}

TEST_CASE("times to think that contradict one another are refused") {
  CHECK_THAT(refusal({{"thought", {{"easy_s", 3}, {"hard_s", 2}}}}), holds_text("/thought"));
  CHECK_THAT(refusal({{"thought", {{"shift_s", 3}, {"longest_s", 2}}}}),
             holds_text("/thought") && holds_text("longest_s"));
}

TEST_CASE("a training has one of two names, and people think alike without the key") {
  CHECK(parsed({{"training", "own"}}).training == simulation::Training::own);
  CHECK(parsed(json::object()).training == simulation::Training::shared);
  CHECK_THAT(refusal({{"training", "owns"}}), holds_text("/training"));
  CHECK_FALSE(parsed(json::object()).thought.has_value());
  CHECK_FALSE(
      json::parse(simulation::subject_model_json(parsed(json::object()))).contains("thought"));
}

TEST_CASE("a subject model that is written is read back as the same one, to the last digit") {
  simulation::SubjectModel model;
  model.feature_noise = 0.1 + 0.2;
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
  model.training_passes = 3;
  model.training = simulation::Training::own;
  model.memory_noise = 0.1;
  model.learning = {.factor = 1.7, .trials = 33.0, .forgotten = 0.3, .spread = 0.2};
  model.period_noise_spread = 0.15;
  model.serial = {.answer = 0.4, .answer_spread = 0.2, .stimulus = -0.3, .stimulus_spread = 0.05};
  model.fatigue = {.noise_per_min = 0.02, .lapse_per_min = 0.1, .recovered = 0.6};
  model.thought = simulation::ThoughtTime{.shift_s = 0.2, .easy_s = 0.7};
  model.given_function = simulation::GivenFunction{-18.0, 2.0, 3.5, 0.02};
  const std::string written = simulation::subject_model_json(model);
  const simulation::SubjectModel read = simulation::parse_subject_model(written, "written");
  CHECK(simulation::subject_model_json(read) == written);
  CHECK(read.feature_noise == model.feature_noise);
  CHECK(read.feature_noise_spread == model.feature_noise_spread);
  CHECK(read.class_bias == model.class_bias);
  CHECK(read.label_swap == model.label_swap);
  CHECK(read.position_bias_spread == 0.25);
  CHECK(read.training_passes == 3);
  CHECK(read.training == simulation::Training::own);
  CHECK(read.memory_noise == 0.1);
  CHECK(read.learning == model.learning);
  CHECK(read.period_noise_spread == 0.15);
  CHECK(read.serial == model.serial);
  CHECK(read.fatigue == model.fatigue);
  CHECK(read.thought == model.thought);
  CHECK(read.given_function == model.given_function);
}

}  // namespace
}  // namespace touchtrial
