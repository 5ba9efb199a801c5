#include "core/errors.hpp"
#include "core/files.hpp"
#include "study/study_examples.hpp"
#include "study/study_key.hpp"
#include "study/study_sections.hpp"
#include "support/temp_folder.hpp"

namespace touchtrial {

using nlohmann::json;

TEST_CASE("practice, session and registration are read with every key") {
  const study::Study study = parsed(planned_study());
  CHECK(study.trials.practice == 5);
  REQUIRE(study.practice.classes.size() == 2);
  CHECK(study.practice.classes[1].label == "velvet");
  CHECK(study.practice.criterion == 4);
  const study::SessionPlan& session = study.session;
  CHECK(session.language == "en");
  CHECK(session.instructions.at("en").front() == "Feel the plane.\n\nSlowly.");
  CHECK(session.sight == study::Sight::blindfold);
  CHECK(session.masking == study::MaskingPlan{});
  CHECK(session.confidence_levels == 5);
  CHECK(session.day_sheet == std::vector<std::string>{"Door shut"});
  REQUIRE(session.closing_questions.size() == 1);
  CHECK(session.closing_questions[0].kind == study::QuestionKind::choice);
  CHECK(session.closing_questions[0].options[1].at("de") == "Tiefe");
  CHECK(study.registration.participants == 20);
}

TEST_CASE("a study without the sections has the documented plan") {
  const study::Study study = parsed(minimal_study());
  CHECK(study.practice == study::PracticePlan{});
  CHECK(study.session == study::SessionPlan{});
  CHECK(study.registration == study::Registration{});
}

TEST_CASE("the plans, written as JSON, are read as they were") {
  const study::Study study = parsed(planned_study());
  json again = planned_study();
  again["practice"] = study::to_json(study.practice);
  again["session"] = study::to_json(study.session);
  again["registration"] = study::to_json(study.registration);
  CHECK(parsed(again).practice == study.practice);
  CHECK(parsed(again).session == study.session);
  CHECK(parsed(again).registration == study.registration);
}

TEST_CASE("a key gives the plans back as they were sealed") {
  const TempFolder folder;
  SeededEntropy entropy(1);
  const study::StudyKey key =
      study::make_study_key(parsed(planned_study(), folder.path()), entropy, false);
  study::save_study_key(folder.path() / "small.key", key);
  const study::StudyKey loaded = study::load_study_key(folder.path() / "small.key");
  CHECK(loaded.study.practice == key.study.practice);
  CHECK(loaded.study.session == key.study.session);
  CHECK(loaded.study.registration == key.study.registration);
  CHECK(study::study_seal(loaded) == study::study_seal(key));
}

TEST_CASE("what nobody can practise, read or be asked is refused at its place") {
  struct Refused {
    const char* place;
    json value;  ///< null: the place is erased
    const char* words;
  };
  const std::string long_text(4001, 'x');
  const std::vector<Refused> all = {
      {"/practice/classes/1/label", "c2",
       "/practice/classes/1/label: \"c2\" is a class of the study"},
      {"/practice/classes/1/label", "C2",
       "/practice/classes/1/label: \"C2\" is a class of the study"},
      {"/practice/classes/1/label", "\xd1\x81-2",  // a Cyrillic c
       "/practice/classes/1/label: \"\xd1\x81-2\" is a class of the study"},
      {"/practice/classes/0/images",
       {"x/../c1_0.png"},
       "/practice/classes/0/images/0: \"x/../c1_0.png\" is an image of the"},
      {"/practice/classes/0/images",
       {"velvet.png"},
       "/practice/classes/1/images/0: \"velvet.png\" is the image of another"},
      {"/practice", {}, "/trials/practice: is 5, but the study has no textures to practise"},
      {"/practice/criterion", 6,
       "/practice/criterion: is 6, more than the practice trials of a round, 5"},
      {"/session/handednes", true,
       "/session/handednes: is not a known key; did you mean \"handedness\"?"},
      {"/session/sight", "curtains", "did you mean \"curtain\"?"},
      {"/registration/hypotesis", "", "did you mean \"hypothesis\"?"},
      {"/session/language", "de", "/session/instructions/de: is missing, the study's language"},
      {"/session/instructions/en/0", "", "is empty; write a page"},
      {"/session/instructions/en/0", "a\tb", "control character"},
      {"/session/instructions/en/0", long_text, "has 4001 bytes"},
      {"/session/day_sheet", {"a", "a"}, "/session/day_sheet/1: \"a\" is there"},
      {"/session/day_sheet", {"a\nb"}, "control character"},
      {"/session/confidence", 1, "/session/confidence: is 1, must be 0"},
      {"/session/closing_questions/0/id", "a b", "must have 1 to 64"},
      {"/session/closing_questions/0/text/en", "", "is empty"},
      {"/registration/exclusions", long_text, "at most 4000"}};
  for (const auto& [place, value, words] : all) {
    json document = planned_study();
    const json::json_pointer at(place);
    if (value.is_null()) {
      document[at.parent_pointer()].erase(at.back());
    } else {
      document[at] = value;
    }
    INFO(place << " = " << value.dump());
    CHECK(refused(document, words));
  }
}

TEST_CASE("a criterion without practice, and a language without texts of the study, are accepted") {
  json document = planned_study();
  document["practice"]["criterion"] = 6;
  document["trials"]["practice"] = 0;
  CHECK(parsed(document).practice.criterion == 6);
  document["session"]["language"] = "de";
  document["session"].erase("instructions");
  CHECK(refused(document, "/session/closing_questions/0/text/de: is missing"));
  document["session"].erase("closing_questions");
  CHECK(parsed(document).session.language == "de");
}

TEST_CASE("bounds belong to questions for a number, and leave one between them") {
  json document = planned_study();
  json& question = document["session"]["closing_questions"][0];
  question["min"] = 18;
  CHECK(refused(document, "/session/closing_questions/0/min: belongs to a question"));
  question["kind"] = "number";
  question.erase("options");
  question["max"] = 99.5;
  const study::Question read = parsed(document).session.closing_questions[0];
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
  CHECK(parsed(document).session.closing_questions[0].kind == study::QuestionKind::number);
  questions[0]["kind"] = "choice";
  CHECK(refused(document, "/session/closing_questions/0/options: is missing"));
}

}  // namespace touchtrial
