#include "app/texts/study_texts.hpp"

#include "app/windows/participant/words.hpp"
#include "protocols/identification/study/identification.hpp"
#include "study/deviation_codes.hpp"
#include "study/languages.hpp"
#include "study/protocol.hpp"
#include "support/catch.hpp"

#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial {
namespace {

void give_protocol(study::Study& study, const study::Protocol& protocol) {
  study.protocol = &protocol;
  study.task = protocol.read(std::nullopt);
}

study::Study two_textures() {
  study::Study study;
  give_protocol(study, study::identification::classification());
  study.classes = {{"bark", {}}, {"cloth", {}}};
  return study;
}

std::string all_of(const std::vector<std::string>& pages) {
  std::string text;
  for (const std::string& page : pages) text += page + "\n";
  return text;
}

bool has(const std::vector<session::DaySheetItem>& sheet, std::string_view code) {
  for (const session::DaySheetItem& item : sheet) {
    if (item.code == code) return true;
  }
  return false;
}

/// One study for each combination of options that change texts.
std::vector<study::Study> every_kind(const std::string& language) {
  std::vector<study::Study> studies;
  for (int bits = 0; bits < 32; ++bits) {
    study::Study study = two_textures();
    study.session.language = language;
    if ((bits & 1) != 0) give_protocol(study, study::identification::comparison());
    if ((bits & 2) != 0) study.session.sight = study::Sight::blindfold;
    if ((bits & 4) != 0) study.trials.on_timeout = study::OnTimeout::no_response;
    if ((bits & 8) != 0) {
      study.trials.practice = 5;
      study.practice.classes = {{"felt", {}}, {"cork", {}}};
    }
    if ((bits & 16) != 0) {
      study.session.confidence_levels = 5;
      study.session.consent_version = "2026-03";
    }
    studies.push_back(study);
  }
  return studies;
}

/// Whether a protocol names the text, which the window then looks up.
bool is_named_by_protocol(const std::string& key) {
  return key.starts_with("threshold_") || key.starts_with("choice_") || key == "rate_title" ||
         key.starts_with("scale_fit");
}

TEST_CASE("the window uses every text of the screens, and no other") {
  study::Texts texts = study::language_of("en").texts;
  const app::Words words = app::words_of(texts);
  CHECK(words.next == "Next");
  for (const auto& [key, text] : study::language_of("en").texts.at("screens")) {
    INFO(key);
    if (is_named_by_protocol(key)) {
      CHECK(app::title_of(words, key) == text);
      continue;
    }
    study::Texts without = texts;
    without.at("screens").erase(key);
    CHECK_THROWS_AS(app::words_of(without), std::out_of_range);
  }
}

TEST_CASE("values take the places of the words in braces, wherever these are") {
  CHECK(app::fill_numbers("{of} ... {trial} of {of}", {{"trial", 7}, {"of", 25}}) ==
        "25 ... 7 of 25");
  CHECK(app::fill_placeholders("It was: {label}", {{"label", "{label} {of}"}}) ==
        "It was: {label} {of}");
}

TEST_CASE("instructions of every study hold its numbers and no word in braces") {
  for (const std::string_view code : study::language_codes()) {
    const std::string language(code);
    CAPTURE(language);
    for (const study::Study& study : every_kind(language)) {
      const session::SessionTexts texts = app::session_texts(study);
      CHECK(texts.instructions.size() >= 6);
      std::string text = all_of(texts.instructions);
      CHECK(text.find("60") != std::string::npos);
      for (const session::DaySheetItem& item : texts.day_sheet) text += item.text;
      CHECK(text.find_first_of("{}") == std::string::npos);
      CHECK(text.find("bark") == std::string::npos);
      // Speeds and forces of good strokes.
      CHECK(text.find("50") != std::string::npos);
      CHECK(text.find(study::has_decimal_comma(code) ? "0,5" : "0.5") != std::string::npos);
    }
  }
}

/// One study for each combination of options that change texts of trials with several planes.
std::vector<study::Study> every_kind_with_intervals(const std::string& language) {
  std::vector<study::Study> studies;
  for (const char* name : {"detection", "discrimination", "discrimination-order"}) {
    for (int bits = 0; bits < 4; ++bits) {
      study::Study study = study::load_study(std::filesystem::path(TOUCHTRIAL_SOURCE_DIR) /
                                             "config" / (std::string(name) + ".json"));
      study.session.language = language;
      if ((bits & 1) != 0) study.session.sight = study::Sight::blindfold;
      if ((bits & 2) != 0) study.session.confidence_levels = 5;
      studies.push_back(study);
    }
  }
  return studies;
}

/// What of questionnaires is read in a language.
std::string read_in(const std::string& language, const std::vector<study::Questionnaire>& all) {
  std::string text;
  for (const study::Questionnaire& one : all) {
    text += one.name + "\n";
    for (const study::Question& question : one.questions) {
      text += question.id + ": " + question.text.at(language) + "\n";
      for (const auto& option : question.options) text += "- " + option.at(language) + "\n";
    }
  }
  return text;
}

TEST_CASE("texts for blindfolded participants mention nothing to look at") {
  const std::map<std::string, std::vector<std::string>> to_see = {
      {"en", {"picture", "bars", "curtain"}}, {"de", {"Bild", "Balken", "Vorhang"}},
      {"fr", {"image", "barres", "rideau"}},  {"es", {"imagen", "imágenes", "barras", "cortina"}},
      {"zh", {"图", "横条", "帘"}},           {"ja", {"写真", "画像", "棒", "カーテン"}}};
  for (const std::string_view code : study::language_codes()) {
    const std::string language(code);
    CAPTURE(language);
    std::vector<study::Study> studies = every_kind(language);
    for (const study::Study& study : every_kind_with_intervals(language)) studies.push_back(study);
    for (const study::Study& study : studies) {
      const app::Words words = app::words_of(study::texts_of(study.session));
      std::string text = all_of(app::session_texts(study).instructions);
      const bool sees = study.session.sight != study::Sight::blindfold;
      if (!sees) text += words.practice_text_blindfold + words.practice_text_intervals;
      for (const std::string* const card :
           {&words.practice_over_text, &words.practice_over_text_feedback, &words.ready_text,
            &words.ready_text_intervals, &words.interval_text, &words.not_explored_text,
            &words.answer_spoken_title, &words.answer_spoken_text, &words.answer_spoken_choice,
            &words.time_is_up, &words.no_response_text, &words.it_was, &words.break_text}) {
        if (!sees) text += *card;
      }
      bool speaks = false;
      for (const std::string& word : to_see.at(language)) {
        speaks = speaks || text.find(word) != std::string::npos;
      }
      CHECK(speaks == sees);
    }
  }
}

TEST_CASE("a study's questionnaires alone are those of its session, in its language") {
  for (const std::string_view code : study::language_codes()) {
    const std::string language(code);
    for (const study::Study& study : every_kind(language)) {
      const session::SessionTexts texts = app::session_texts(study);
      std::vector<study::Questionnaire> expected;
      for (const auto& one : {texts.handedness, texts.closing}) {
        if (one) expected.push_back(*one);
      }
      CHECK(read_in(language, app::questionnaires_of(study)) == read_in(language, expected));
    }
  }
}

TEST_CASE("instructions of trials with several planes hold their numbers and their question") {
  for (const std::string_view code : study::language_codes()) {
    const std::string language(code);
    CAPTURE(language);
    const app::Words words = app::words_of(study::language_of(code).texts);
    for (const study::Study& study : every_kind_with_intervals(language)) {
      const study::TrialQuestion ask = study::trial_question_of(study);
      const session::SessionTexts texts = app::session_texts(study);
      CHECK(texts.instructions.size() == 7);
      const std::string text = all_of(texts.instructions);
      CHECK(text.find_first_of("{}") == std::string::npos);
      CHECK(text.find(app::title_of(words, ask.title())) != std::string::npos);
      CHECK(app::title_of(words, ask.title()) != words.answer_title);
      for (const std::string& number :
           {std::to_string(ask.planes), std::string("15"),
            std::string(study::has_decimal_comma(code) ? "2,5" : "2.5")}) {
        CHECK(text.find(number) != std::string::npos);
      }
    }
  }
}

TEST_CASE("where a trial has several planes, no text speaks of pictures or of names of textures") {
  for (const study::Study& study : every_kind_with_intervals("en")) {
    const session::SessionTexts texts = app::session_texts(study);
    const std::string text = all_of(texts.instructions);
    CHECK(text.find("picture") == std::string::npos);
    CHECK_FALSE(has(texts.day_sheet, "no-labels-learnt"));
  }
}

TEST_CASE("choices that are words are in the words' language, and others stay as they are") {
  const app::Words german = app::words_of(study::language_of("de").texts);
  CHECK(app::choice_text(german, "third") == "Die dritte");
  CHECK(app::choice_text(german, "different") == "Verschieden");
  CHECK(app::choice_text(german, "bark") == "bark");
  CHECK(app::title_of(german, "threshold_coarser") == "Welche Oberfläche war gröber?");
  CHECK(app::title_of(german, "") == german.answer_title);
}

TEST_CASE("a study's own instructions replace the program's in their language only") {
  study::Study study = two_textures();
  study.session.instructions["de"] = {"Nur das, {limit}."};
  CHECK(app::session_texts(study).instructions.size() > 1);
  study.session.language = "de";
  CHECK(app::session_texts(study).instructions == std::vector<std::string>{"Nur das, {limit}."});
}

TEST_CASE("a protocol of which the texts have no page needs the study's own instructions") {
  study::Study study = two_textures();
  study::Protocol other = study::identification::classification();
  other.name = "presence";
  give_protocol(study, other);
  CHECK_THROWS_WITH(app::session_texts(study), holds_text("/session/instructions"));
  study.session.instructions["en"] = {"Say whether there was a texture."};
  CHECK(app::session_texts(study).instructions ==
        std::vector<std::string>{"Say whether there was a texture."});
}

TEST_CASE("a study replaces one page of the instructions by its own") {
  study::Study study = two_textures();
  const std::size_t pages = app::session_texts(study).instructions.size();
  study.session.texts["en"]["instructions"]["welcome"] = "Hello.";
  study.session.texts["de"]["instructions"]["comfort"] = "Halt.";
  const std::vector<std::string> own = app::session_texts(study).instructions;
  CHECK(own.size() == pages);
  CHECK(own.front() == "Hello.");
  CHECK(own.back() != "Halt.");
}

TEST_CASE("texts are in English if the program does not have the study's language") {
  study::Study study = two_textures();
  const session::SessionTexts english = app::session_texts(study);
  study.session.language = "xx";
  CHECK(app::session_texts(study).instructions == english.instructions);
}

TEST_CASE("the handedness inventory has four items with five options, then asks for the pen") {
  study::Study study = two_textures();
  const auto inventory = app::session_texts(study).handedness;
  REQUIRE(inventory);
  REQUIRE(inventory->questions.size() == 5);
  for (int i = 0; i < 4; ++i) CHECK(inventory->questions[i].options.size() == 5);
  CHECK(inventory->questions[4].id == "pen-hand");
  CHECK(inventory->questions[0].text.at("de") == "Welche Hand benutzen Sie zum Schreiben?");
  CHECK(inventory->questions[0].options[4].at("en") == "Always left");
  study.session.language = "de";
  study.session.texts["de"]["handedness"]["spoon"] = "Und den Löffel?";
  const auto german = app::session_texts(study).handedness;
  CHECK(german->questions[0].text.at("de") == "Welche Hand benutzen Sie zum Schreiben?");
  CHECK(german->questions[3].text.at("de") == "Und den Löffel?");
  CHECK(german->questions[3].text.at("en") == "Which hand do you use for a spoon?");
  study.session.handedness = false;
  CHECK_FALSE(app::session_texts(study).handedness);
}

TEST_CASE("a study's closing questions follow the program's or replace them") {
  study::Study study = two_textures();
  const std::size_t own = app::session_texts(study).closing.value().questions.size();
  study::Question more;
  more.id = "tired";
  study.session.closing_questions = {more};
  CHECK(app::session_texts(study).closing.value().questions.size() == own + 1);
  more.id = "heard";
  more.text["en"] = "Loud?";
  study.session.closing_questions = {more};
  const auto questions = app::session_texts(study).closing.value().questions;
  CHECK(questions.size() == own);
  CHECK(questions.front().text.at("en") == "Loud?");
  study.session.closing = false;
  CHECK(app::session_texts(study).closing.value().questions.size() == 1);
  study.session.closing_questions.clear();
  CHECK_FALSE(app::session_texts(study).closing);
}

TEST_CASE("the day sheet has what the study needs, each with a deviation code of its own") {
  study::Study study = two_textures();
  study.session.consent_version = "2026-03";
  study.session.day_sheet = {"The window is shut"};
  const std::vector<session::DaySheetItem> sheet = app::session_texts(study).day_sheet;
  for (const char* code : {"no-warm-up", "no-calibration", "no-fixture-touch", "no-curtain",
                           "no-headphones", "no-masking-level", "no-consent",
                           "no-gravity-compensation", "no-placement", "no-day-sheet-1"}) {
    CHECK(has(sheet, code));
  }
  CHECK(sheet.front().text.find("2026-03") != std::string::npos);
  CHECK(sheet.back().text == "The window is shut");
  study.session.masking.wanted = false;
  study.session.sight = study::Sight::blindfold;
  const std::vector<session::DaySheetItem> blind = app::session_texts(study).day_sheet;
  CHECK_FALSE(has(blind, "no-headphones"));
  CHECK_FALSE(has(blind, "no-curtain"));
  CHECK(has(blind, "no-labels-learnt"));
  for (const std::vector<session::DaySheetItem>* const items : {&sheet, &blind}) {
    for (const session::DaySheetItem& item : *items) CHECK(study::is_deviation_code(item.code));
  }
}

}  // namespace
}  // namespace touchtrial
