#include "protocols/simulation/subject_model.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "support/catch.hpp"

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
  try {
    static_cast<void>(parsed(subject));
  } catch (const StudyError& error) {
    return error.what();
  }
  return "";
}

design::Study study_of(const std::vector<std::string>& labels) {
  design::Study study;
  for (const std::string& label : labels) study.classes.push_back({label, {}});
  return study;
}

TEST_CASE("a subject file says everything about a subject") {
  const simulation::SubjectModel subject =
      parsed({{"weber", 0.3},
              {"weber_spread", 0.1},
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
              {"training_passes", 3}});
  CHECK(subject.weber == 0.3);
  CHECK(subject.weber_spread == 0.1);
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
  CHECK(subject.weber == 0.0);
  CHECK(subject.lapse == 0.0);
  CHECK(subject.explore_s == 10.0);
  CHECK(subject.push_n == 0.7);
}

TEST_CASE("a subject file is refused with the place and a remedy") {
  using Catch::Contains;
  CHECK_THAT(refusal({{"webber", 0.3}}), Contains("subject.json: /webber") && Contains("weber"));
  CHECK_THAT(refusal({{"lapse", 1.5}}), Contains("/lapse"));
  CHECK_THAT(refusal({{"push_n", "hard"}}), Contains("/push_n"));
  CHECK_THAT(refusal({{"bias", {{"positon", 1}}}}), Contains("/bias/positon"));
  CHECK_THAT(refusal({{"label_swap", pairs({{"a", "b"}, {"b", "c"}})}}),
             Contains("/label_swap/1/0"));
  CHECK_THAT(refusal({{"label_swap", pairs({{"a"}})}}), Contains("/label_swap/0"));
  CHECK_THAT(refusal({{"slowest_mm_s", 200}}), Contains("/slowest_mm_s"));
  CHECK_THAT(refusal({{"fastest_mm_s", 20}}), Contains("/fastest_mm_s"));
  CHECK_THAT(refusal(json::array()), Contains("subject.json"));
  CHECK_THROWS_AS(simulation::parse_subject_model("{", "subject.json"), StudyError);
  CHECK_THROWS_AS(simulation::load_subject_model("no/such/subject.json"), FileError);
}

TEST_CASE("a label that the study does not have is refused with its place") {
  using Catch::Contains;
  const design::Study study = study_of({"bark", "straw", "brick"});
  CHECK_NOTHROW(parsed({{"label_swap", pairs({{"bark", "straw"}})}}).check_labels(study));
  CHECK_THROWS_WITH(parsed({{"label_swap", pairs({{"bark", "strew"}})}}).check_labels(study),
                    Contains("subject.json: /label_swap/0/1") && Contains("straw"));
  const json biased = {{"bias", {{"classes", {{{"label", "sand"}, {"log_odds", 1}}}}}}};
  CHECK_THROWS_WITH(parsed(biased).check_labels(study), Contains("/bias/classes/0/label"));
}

TEST_CASE("the subject files that come with the program are accepted") {
  const auto folder = kRoot / "config" / "subjects";
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    CHECK_NOTHROW(simulation::load_subject_model(entry.path()));
    names.insert(entry.path().filename().string());
  }
  CHECK(names.contains("default.json"));
  CHECK(simulation::load_subject_model(folder / "ideal.json").weber == 0.0);
  CHECK(simulation::load_subject_model(folder / "swapped.json").label_swap.size() == 1);
}

TEST_CASE("the schema of subject files and the reader know the same keys and bounds") {
  const json schema =
      json::parse(text_of(read_file(kRoot / "config" / "schema" / "subject.schema.json")));
  REQUIRE(schema.at("additionalProperties") == false);
  const std::string known = refusal({{"no such key at all", 1}});
  int bounded = 0;
  for (const auto& item : schema.at("properties").items()) {
    const std::string& key = item.key();
    CHECK_THAT(known, Catch::Contains(key));
    if (!item.value().contains("minimum")) continue;
    ++bounded;
    const double low = item.value().at("minimum");
    const double high = item.value().at("maximum");
    // The other speed makes room, so that each bound is met alone.
    const auto with = [&](double number) {
      json subject = {{"slowest_mm_s", 1}, {"fastest_mm_s", 1000}};
      subject[key] = number;
      return refusal(subject);
    };
    CHECK(with(low).empty());
    CHECK(with(high).empty());
    CHECK_THAT(with(low - 0.001), Catch::Contains("/" + key));
    CHECK_THAT(with(high + 0.001), Catch::Contains("/" + key));
  }
  CHECK(bounded == 9);
  for (const json& example : schema.at("examples")) CHECK(refusal(example).empty());
}

TEST_CASE("the schema and the reader know the same keys and bounds of a bias") {
  const json schema =
      json::parse(text_of(read_file(kRoot / "config" / "schema" / "subject.schema.json")));
  const json& bias = schema.at("properties").at("bias").at("properties");
  const std::string known = refusal({{"bias", {{"no such key at all", 1}}}});
  int bounded = 0;
  for (const auto& item : bias.items()) {
    CHECK_THAT(known, Catch::Contains(item.key()));
    if (!item.value().contains("minimum")) continue;
    ++bounded;
    const auto with = [&](double number) { return refusal({{"bias", {{item.key(), number}}}}); };
    const double low = item.value().at("minimum");
    const double high = item.value().at("maximum");
    CHECK(with(low).empty());
    CHECK(with(high).empty());
    CHECK_THAT(with(low - 0.001), Catch::Contains("/bias/" + item.key()));
    CHECK_THAT(with(high + 0.001), Catch::Contains("/bias/" + item.key()));
  }
  CHECK(bounded == 3);
}

TEST_CASE("a subject model that is written is read back as the same one, to the last digit") {
  simulation::SubjectModel model;
  model.weber = 0.1 + 0.2;
  model.weber_spread = 1.0 / 3.0;
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
  const std::string written = simulation::subject_model_json(model);
  const simulation::SubjectModel read = simulation::parse_subject_model(written, "written");
  CHECK(simulation::subject_model_json(read) == written);
  CHECK(read.weber == model.weber);
  CHECK(read.weber_spread == model.weber_spread);
  CHECK(read.class_bias == model.class_bias);
  CHECK(read.label_swap == model.label_swap);
  CHECK(read.position_bias_spread == 0.25);
  CHECK(read.training_passes == 3);
}

}  // namespace
}  // namespace touchtrial
