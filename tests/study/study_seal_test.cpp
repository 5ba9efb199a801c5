#include "study/study_examples.hpp"
#include "study/study_key.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <functional>
#include <set>

namespace touchtrial {
namespace {

using nlohmann::json;

study::StudyKey key_for(const json& document, std::uint64_t seed = 1) {
  SeededEntropy entropy(seed);
  return study::make_study_key(parsed(document), entropy, false);
}

using Changes = std::vector<std::function<void(json&)>>;

/// The seals of a study and of each changed one; checks that they all differ.
std::set<Digest> seals_of(const json& study, const Changes& changes) {
  std::set<Digest> seals = {study::study_seal(key_for(study))};
  for (const auto& change : changes) {
    json document = study;
    change(document);
    seals.insert(study::study_seal(key_for(document)));
  }
  CHECK(seals.size() == changes.size() + 1);
  return seals;
}

json labelled_study() {
  json document = comparison_of(3, 2);
  document["classes"][0]["label"] = "bark";
  document["seed"] = 31875542;
  return document;
}

}  // namespace

TEST_CASE("the configuration in clear has no label, image name or seed") {
  const std::string text = study::blinded_configuration(key_for(labelled_study()));
  for (const char* secret :
       {"bark", "c1_0", "c2_1", ".png", "31875542", "seed", "label", "classes"}) {
    INFO(secret);
    CHECK(text.find(secret) == std::string::npos);
  }
  const json configuration = json::parse(text);
  CHECK(configuration["study"] == "small");
  CHECK(configuration["protocol"] == "comparison");
  CHECK(configuration["positions"] == 3);
  CHECK(configuration["blinding"] == "double");
  CHECK(configuration["methods"][0] == json{{"name", "adaptive"},
                                            {"radius", 2},
                                            {"norm", "additive"},
                                            {"gradient", "sobel"},
                                            {"combine", "sum"},
                                            {"levels", 1}});
  CHECK(configuration["rendering"]["pitch_mm"] == 0.2);
  CHECK(configuration["trials"]["repeats"] == 5);
}

TEST_CASE("the codes in clear are sorted, so that their order tells nothing") {
  const study::StudyKey key = key_for(labelled_study());
  const std::vector<std::string> codes = json::parse(study::blinded_configuration(key))["stimuli"];
  REQUIRE(codes.size() == key.stimuli.size());
  CHECK(std::is_sorted(codes.begin(), codes.end()));
  std::vector<std::string> in_study_order;
  for (const study::KeyedStimulus& stimulus : key.stimuli) in_study_order.push_back(stimulus.code);
  CHECK_FALSE(in_study_order == codes);
}

TEST_CASE("the order of classes and images in the study does not show in clear") {
  json document = labelled_study();
  const std::string before = study::blinded_configuration(key_for(document));
  std::swap(document["classes"][0], document["classes"][2]);
  std::swap(document["classes"][1]["images"][0], document["classes"][1]["images"][1]);
  CHECK(study::blinded_configuration(key_for(document)) == before);
}

TEST_CASE("the sections in clear, read again, give the same study options") {
  json document = labelled_study();
  document["rendering"] = {{"gains", {{"tangential_n", 0.1}, {"normal_n", 1e-3}}},
                           {"filter_mm", 0.30000000000000004}};
  document["trials"] = {{"order", "uniform"}, {"blocks", "mixed"}};
  document["methods"] = {{{"name", "fixed"}, {"order", 1.0 / 3.0}}, {{"name", "tv-gabor"}}};
  const study::StudyKey key = key_for(document);
  const json configuration = json::parse(study::blinded_configuration(key));
  for (const char* section : {"rendering", "trials", "methods"}) {
    document[section] = configuration[section];
  }
  const study::Study again = parsed(document);
  CHECK(again.rendering == key.study.rendering);
  CHECK(again.trials == key.study.trials);
  CHECK(again.methods == key.study.methods);
}

TEST_CASE("a study that has none of the newer keys keeps its configuration and seal") {
  // Written by the program before it knew practice, sessions and registrations.
  json document = labelled_study();
  study::StudyKey key = key_for(document);
  CHECK(to_hex(study::study_seal(key)) ==
        "7a99dfb9931d6980fee200cece8550a18cb1a14953dbec6d130f59591b44c24d");
  const std::string trials =
      R"("trials":{"blocks":"by-method","break_every":0,"catch":0,"explore_limit_s":60.0,)"
      R"("lead_in":0,"on_timeout":"fade","order":"shuffled","practice":0,"repeats":5}})";
  CHECK(study::blinded_configuration(key).ends_with(trials));
  document["trials"] = {{"order", "de-bruijn"}, {"repeats", 3}, {"break_every", 7}};
  key = key_for(document);
  CHECK(to_hex(study::study_seal(key)) ==
        "b5a76460fb6efe5b24e73700dd5f156e094b8a014d6760b25859e0603a98a4c4");
  document["practice"]["classes"] = planned_study()["practice"]["classes"];
  CHECK_FALSE(study::study_seal(key_for(document)) == study::study_seal(key));
}

TEST_CASE("no text of practice, session or registration is stored in clear") {
  const std::string text = study::blinded_configuration(key_for(planned_study()));
  for (const char* secret : {"corduroy", "velvet", ".png", "Feel the plane", "Door shut", "form 3",
                             "2026-17", "Which cue", "Edges", "They can."}) {
    INFO(secret);
    CHECK(text.find(secret) == std::string::npos);
  }
  const json configuration = json::parse(text);
  CHECK(configuration["practice"] == json{{"positions", 2}, {"criterion", 4}, {"rounds", 2}});
  CHECK(configuration["session"] == json{{"language", "en"},
                                         {"sight", "blindfold"},
                                         {"masking", {{"wanted", true}, {"level_dbfs", -30.0}}},
                                         {"handedness", true},
                                         {"confidence", 5},
                                         {"closing", true}});
  CHECK(configuration["texts"].get<std::string>().size() == 64);
  CHECK_FALSE(configuration["texts"] ==
              json::parse(study::blinded_configuration(key_for(planned_study(), 2)))["texts"]);
}

TEST_CASE("any change of what people read or are asked changes the seal") {
  const Changes changes = {
      [](json& d) { d["practice"]["classes"][0]["label"] = "other"; },
      [](json& d) { d["practice"]["classes"][0]["images"] = {"other.png"}; },
      [](json& d) { d["practice"]["criterion"] = 3; },
      [](json& d) { d["practice"]["rounds"] = 1; },
      [](json& d) { d["session"]["instructions"]["en"][0] = "Press."; },
      [](json& d) { d["session"]["texts"]["en"]["screens"]["next"] = "On"; },
      [](json& d) { d["session"]["text_scale"] = 1.25; },
      [](json& d) { d["session"]["high_contrast"] = true; },
      [](json& d) { d["session"]["masking"]["level_dbfs"] = -20; },
      [](json& d) { d["session"]["sight"] = "curtain"; },
      [](json& d) { d["session"]["closing_questions"][0]["text"]["en"] = "What?"; },
      [](json& d) { d["session"]["consent_version"] = "form 4"; },
      [](json& d) { d["session"]["day_sheet"] = json::array(); },
      [](json& d) { d["registration"]["participants"] = 21; },
      [](json& d) { d["registration"]["hypothesis"] = "They cannot."; },
      [](json& d) { d["trials"]["practice"] = 6; },
      [](json& d) { d["trials"]["catch"] = 1; },
      [](json& d) { d["trials"]["max_run"] = 2; },
      [](json& d) { d["trials"]["rove_db"] = 3; },
      [](json& d) { d["trials"]["order"] = "williams"; },
      [](json& d) { d["trials"]["on_interruption"] = "restart-block"; },
      [](json& d) { d["trials"]["resume_within_h"] = 1; }};
  static_cast<void>(seals_of(planned_study(), changes));
}

TEST_CASE("any change of study, secrets or codes changes the seal") {
  const Changes changes = {
      [](json& d) { d["study"] = "other"; },
      [](json& d) { d["protocol"] = "classification"; },
      [](json& d) { d["classes"][1]["label"] = "other"; },
      [](json& d) { d["classes"][1]["images"][0] = "other.png"; },
      [](json& d) { std::swap(d["classes"][0], d["classes"][1]); },
      [](json& d) { std::swap(d["classes"][0]["images"][0], d["classes"][0]["images"][1]); },
      [](json& d) { std::swap(d["methods"][0], d["methods"][1]); },
      [](json& d) { d["methods"][0]["radius"] = 3; },
      [](json& d) { d["methods"][1]["gap"] = 1e-4; },
      [](json& d) { d["rendering"]["pitch_mm"] = 0.21; },
      [](json& d) { d["rendering"]["max_force_n"] = 3.4; },
      [](json& d) { d["rendering"]["equalise"] = "rms"; },
      [](json& d) { d["trials"]["repeats"] = 4; },
      [](json& d) { d["trials"]["order"] = "uniform"; },
      [](json& d) { d["trials"]["explore_limit_s"] = 61; },
      [](json& d) { d["trials"]["blocks"] = "mixed"; },
      [](json& d) { d["seed"] = 2; }};
  std::set<Digest> seals = seals_of(labelled_study(), changes);
  study::StudyKey key = key_for(labelled_study());
  key.master[31] ^= 1U;
  CHECK(seals.insert(study::study_seal(key)).second);
  key = key_for(labelled_study());
  key.simulated = true;
  CHECK(seals.insert(study::study_seal(key)).second);
  key = key_for(labelled_study());
  std::swap(key.stimuli[0].code, key.stimuli[5].code);
  CHECK(seals.insert(study::study_seal(key)).second);
}

TEST_CASE("where a study lies and how its file is laid out do not change the seal") {
  SeededEntropy entropy(1);
  const study::Study moved =
      study::parse_study(labelled_study().dump(4), "elsewhere", "other.json");
  CHECK(study::study_seal(study::make_study_key(moved, entropy, false)) ==
        study::study_seal(key_for(labelled_study())));
}

}  // namespace touchtrial
