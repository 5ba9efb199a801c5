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
    const char* places;
  };
  const std::string long_text(4001, 'x');
  const std::vector<Refused> all = {
      {"/practice/classes/1/label", "c2", "/practice/classes/1/label c2"},
      {"/practice/classes/1/label", "C2", "/practice/classes/1/label C2"},
      {"/practice/classes/1/label", "\xd1\x81-2",  // a Cyrillic c
       "/practice/classes/1/label \xd1\x81-2"},
      {"/practice/classes/0/images",
       {"x/../c1_0.png"},
       "/practice/classes/0/images/0 x/../c1_0.png"},
      {"/practice/classes/0/images", {"velvet.png"}, "/practice/classes/1/images/0 velvet.png"},
      {"/practice", {}, "/trials/practice 5"},
      {"/practice/criterion", 6, "/practice/criterion 6 5"},
      {"/practice/rounds", 11, "/practice/rounds 11 10"},
      {"/session/handednes", true, "/session/handednes handedness"},
      {"/session/sight", "curtains", "curtain"},
      {"/registration/hypotesis", "", "hypothesis"},
      {"/session/language", "de", "/session/instructions/de"},
      {"/session/instructions/en/0", "", "/session/instructions/en/0"},
      {"/session/instructions/en/0", "a\tb", "/session/instructions/en/0"},
      {"/session/instructions/en/0", long_text, "/session/instructions/en/0 4001"},
      {"/session/day_sheet", {"a", "a"}, "/session/day_sheet/1 a"},
      {"/session/day_sheet", {"a\nb"}, "/session/day_sheet/0"},
      {"/session/confidence", 1, "/session/confidence 1 0"},
      {"/session/closing_questions/0/id", "a b", "1 64"},
      {"/session/closing_questions/0/text/en", "", "/session/closing_questions/0/text/en"},
      {"/registration/exclusions", long_text, "/registration/exclusions 4000"}};
  for (const auto& [place, value, places] : all) {
    json document = planned_study();
    const json::json_pointer at(place);
    if (value.is_null()) {
      document[at.parent_pointer()].erase(at.back());
    } else {
      document[at] = value;
    }
    INFO(place << " = " << value.dump());
    CHECK(refused(document, places));
  }
}

TEST_CASE("a criterion without practice, and a language without texts of the study, are accepted") {
  json document = planned_study();
  document["practice"]["criterion"] = 6;
  document["trials"]["practice"] = 0;
  CHECK(parsed(document).practice.criterion == 6);
  document["session"]["language"] = "de";
  document["session"].erase("instructions");
  CHECK(refused(document, "/session/closing_questions/0/text/de"));
  document["session"].erase("closing_questions");
  CHECK(parsed(document).session.language == "de");
}

TEST_CASE("bounds belong to questions for a number, and leave one between them") {
  json document = planned_study();
  json& question = document["session"]["closing_questions"][0];
  question["min"] = 18;
  CHECK(refused(document, "/session/closing_questions/0/min"));
  question["kind"] = "number";
  question.erase("options");
  question["max"] = 99.5;
  const study::Question read = parsed(document).session.closing_questions[0];
  CHECK(read.min == 18.0);
  CHECK(read.max == 99.5);
  question["max"] = 17;
  CHECK(refused(document, "/session/closing_questions/0/max 17 18"));
}

TEST_CASE("options belong to choices, and questions have ids of their own") {
  json document = planned_study();
  json& questions = document["session"]["closing_questions"];
  questions.push_back(questions[0]);
  CHECK(refused(document, "/session/closing_questions/1/id cue"));
  questions.erase(1);
  questions[0]["kind"] = "number";
  CHECK(refused(document, "/session/closing_questions/0/options"));
  questions[0].erase("options");
  CHECK(parsed(document).session.closing_questions[0].kind == study::QuestionKind::number);
  questions[0]["kind"] = "choice";
  CHECK(refused(document, "/session/closing_questions/0/options"));
}

}  // namespace touchtrial
