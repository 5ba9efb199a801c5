#include "core/errors.hpp"
#include "core/files.hpp"
#include "protocols/design/refusal.hpp"
#include "protocols/design/study_examples.hpp"
#include "protocols/design/study_key.hpp"
#include "protocols/design/study_sections.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

namespace touchtrial {
namespace {

using nlohmann::json;

bool refused(const json& document, const std::string& part) {
  return refuses<StudyError>([&] { return parsed(document); }, part);
}

}  // namespace

TEST_CASE("practice, session and registration are read with every key") {
  const design::Study study = parsed(planned_study());
  CHECK(study.trials.practice == 5);
  REQUIRE(study.practice.classes.size() == 2);
  CHECK(study.practice.classes[1].label == "velvet");
  CHECK(study.practice.criterion == 4);
  const design::SessionPlan& session = study.session;
  CHECK(session.language == "en");
  CHECK(session.instructions.at("en").front() == "Feel the plane.\n\nSlowly.");
  CHECK(session.sight == design::Sight::blindfold);
  CHECK(session.masking == design::MaskingPlan{});
  CHECK(session.confidence_levels == 5);
  CHECK(session.day_sheet == std::vector<std::string>{"Door shut"});
  REQUIRE(session.closing_questions.size() == 1);
  CHECK(session.closing_questions[0].kind == design::QuestionKind::choice);
  CHECK(session.closing_questions[0].options[1].at("de") == "Tiefe");
  CHECK(study.registration.participants == 20);
}

TEST_CASE("a study without the sections has the documented plan") {
  const design::Study study = parsed(minimal_study());
  CHECK(study.practice == design::PracticePlan{});
  CHECK(study.session == design::SessionPlan{});
  CHECK(study.registration == design::Registration{});
}

TEST_CASE("the plans, written as JSON, are read as they were") {
  const design::Study study = parsed(planned_study());
  json again = planned_study();
  again["practice"] = design::to_json(study.practice);
  again["session"] = design::to_json(study.session);
  again["registration"] = design::to_json(study.registration);
  CHECK(parsed(again).practice == study.practice);
  CHECK(parsed(again).session == study.session);
  CHECK(parsed(again).registration == study.registration);
}

TEST_CASE("a key gives the plans back as they were sealed") {
  const TempFolder folder;
  SeededEntropy entropy(1);
  const design::StudyKey key =
      design::make_study_key(parsed(planned_study(), folder.path()), entropy, false);
  design::save_study_key(folder.path() / "small.key", key);
  const design::StudyKey loaded = design::load_study_key(folder.path() / "small.key");
  CHECK(loaded.study.practice == key.study.practice);
  CHECK(loaded.study.session == key.study.session);
  CHECK(loaded.study.registration == key.study.registration);
  CHECK(design::study_seal(loaded) == design::study_seal(key));
}

TEST_CASE("nobody practises with what is in the study, nor with one texture under two names") {
  json document = planned_study();
  document["practice"]["classes"][1]["label"] = "c2";
  CHECK(refused(document, "/practice/classes/1/label: \"c2\" is a class of the study"));
  document["practice"]["classes"][1]["label"] = "C2";
  CHECK(refused(document, "/practice/classes/1/label: \"C2\" is a class of the study"));
  document = planned_study();
  document["practice"]["classes"][0]["images"] = {"x/../c1_0.png"};
  CHECK(refused(document, "/practice/classes/0/images/0: \"x/../c1_0.png\" is an image of the"));
  document["practice"]["classes"][0]["images"] = {"velvet.png"};
  CHECK(refused(document, "/practice/classes/1/images/0: \"velvet.png\" is the image of another"));
}

TEST_CASE("practice without textures, or with a criterion out of reach, is refused") {
  json document = planned_study();
  document.erase("practice");
  CHECK(refused(document, "/trials/practice: is 5, but the study has no textures to practise"));
  document = planned_study();
  document["practice"]["criterion"] = 6;
  CHECK(
      refused(document, "/practice/criterion: is 6, more than the practice trials of a round, 5"));
  document["trials"]["practice"] = 0;
  CHECK(parsed(document).practice.criterion == 6);
}

TEST_CASE("misspelt keys of the plans are refused with the nearest") {
  json document = planned_study();
  document["session"]["handednes"] = true;
  CHECK(refused(document, "/session/handednes: is not a known key; did you mean \"handedness\"?"));
  document = planned_study();
  document["session"]["sight"] = "curtains";
  CHECK(refused(document, "did you mean \"curtain\"?"));
  document = planned_study();
  document["registration"]["hypotesis"] = "";
  CHECK(refused(document, "did you mean \"hypothesis\"?"));
}

TEST_CASE("a text that the study's language lacks is refused") {
  json document = planned_study();
  document["session"]["language"] = "de";
  CHECK(refused(document, "/session/instructions/de: is missing, the study's language"));
  document["session"].erase("instructions");
  CHECK(refused(document, "/session/closing_questions/0/text/de: is missing"));
  document["session"].erase("closing_questions");
  CHECK(parsed(document).session.language == "de");
}

TEST_CASE("texts that a screen or a table could not hold are refused") {
  json document = planned_study();
  const auto with = [&](const std::string& place, const json& value) {
    json changed = document;
    changed[json::json_pointer(place)] = value;
    return changed;
  };
  CHECK(refused(with("/session/instructions/en/0", ""), "is empty; write a page"));
  CHECK(refused(with("/session/instructions/en/0", "a\tb"), "control character"));
  CHECK(refused(with("/session/instructions/en/0", std::string(4001, 'x')), "has 4001 bytes"));
  CHECK(refused(with("/session/day_sheet", {"a", "a"}), "/session/day_sheet/1: \"a\" is there"));
  CHECK(refused(with("/session/day_sheet", {"a\nb"}), "control character"));
  CHECK(refused(with("/session/confidence", 1), "/session/confidence: is 1, must be 0"));
  CHECK(refused(with("/session/closing_questions/0/id", "a b"), "must have 1 to 64"));
  CHECK(refused(with("/session/closing_questions/0/text/en", ""), "is empty"));
  CHECK(refused(with("/registration/exclusions", std::string(4001, 'x')), "at most 4000"));
}

TEST_CASE("bounds belong to questions for a number, and leave one between them") {
  json document = planned_study();
  json& question = document["session"]["closing_questions"][0];
  question["min"] = 18;
  CHECK(refused(document, "/session/closing_questions/0/min: belongs to a question"));
  question["kind"] = "number";
  question.erase("options");
  question["max"] = 99.5;
  const design::Question read = parsed(document).session.closing_questions[0];
  CHECK(read.min == 18.0);
  CHECK(read.max == 99.5);
  question["max"] = 17;
  CHECK(refused(document, "/session/closing_questions/0/max: is 17, less than min, 18"));
}

TEST_CASE("options belong to choices, and questions have ids of their own") {
  json document = planned_study();
  json& questions = document["session"]["closing_questions"];
  questions.push_back(questions[0]);
  CHECK(refused(document, "/session/closing_questions/1/id: \"cue\" is the id of another"));
  questions.erase(1);
  questions[0]["kind"] = "number";
  CHECK(refused(document, "/session/closing_questions/0/options: belongs to a question"));
  questions[0].erase("options");
  CHECK(parsed(document).session.closing_questions[0].kind == design::QuestionKind::number);
  questions[0]["kind"] = "choice";
  CHECK(refused(document, "/session/closing_questions/0/options: is missing"));
}

}  // namespace touchtrial
