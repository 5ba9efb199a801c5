// The languages of the program, and the texts that a study puts in their place.
#include "study/languages.hpp"

#include "core/errors.hpp"
#include "study/laboratory.hpp"
#include "study/protocol.hpp"
#include "study/study_key.hpp"
#include "study/study_sections.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"

#include <set>
#include <vector>

namespace touchtrial {
namespace {

using nlohmann::json;

/// The English file with one change.
json english_with(const std::string& place, const json& text) {
  json file = json::parse(study::language_files().front());
  file[json::json_pointer(place)] = text;
  return file;
}

bool refused_file(const json& file, const std::string& part) {
  return refuses<StudyError>([&] { return study::parse_language(file.dump(), "xx.json"); }, part);
}

json study_with(const std::string& language, const json& texts) {
  json document = minimal_study();
  document["session"] = {{"language", language}, {"texts", {{language, texts}}}};
  return document;
}

bool refused_study(const json& texts, const std::string& part) {
  return refuses<StudyError>([&] { return parsed(study_with("en", texts)); }, part);
}

}  // namespace

TEST_CASE("there are English, German and four drafts, English first") {
  const std::vector<std::string_view>& codes = study::language_codes();
  CHECK(codes.front() == "en");
  CHECK(std::set<std::string_view>(codes.begin(), codes.end()) ==
        std::set<std::string_view>{"en", "de", "es", "fr", "ja", "zh"});
  for (const std::string_view code : study::language_codes()) {
    const study::Language& language = study::language_of(code);
    INFO(code);
    CHECK(language.code == code);
    CHECK(language.draft == (language.code != "en" && language.code != "de"));
    CHECK(study::draft_notice(language.code).empty() != language.draft);
  }
  CHECK_THAT(std::string(study::draft_notice("fr")), names("French"));
  CHECK(study::language_of("de-AT").code == "de");
  CHECK(study::language_of("xx").code == "en");
}

TEST_CASE("a language file with a key missing or too many is refused by the key's place") {
  const json english = json::parse(study::language_files().front());
  CHECK_NOTHROW(study::parse_language(english.dump(), "xx.json"));
  for (const std::string place : {"/screens/next", "/instructions/hand", "/closing/heard_no"}) {
    json file = english;
    const json::json_pointer pointer(place);
    file[pointer.parent_pointer()].erase(pointer.back());
    CHECK(refused_file(file, "xx.json: " + place + " "));
  }
  json file = english;
  file.erase("draft");
  CHECK(refused_file(file, "xx.json /draft"));
  CHECK(refused_file(english_with("/screens/nexd", "On"), "/screens/nexd next"));
  CHECK(refused_file(english_with("/titles", json::object()), "/titles"));
}

TEST_CASE("a language file's texts have the English text's words in braces and pictures") {
  CHECK(refused_file(english_with("/screens/trial_of", "Trial {trial}"), "{of}"));
  CHECK(refused_file(english_with("/screens/next", "{label}"), "{label}"));
  CHECK(refused_file(english_with("/screens/trial_of", "{of} {trial} {of}"), "{of}"));
  CHECK(refused_file(english_with("/screens/trial_of", "{of} {trial"), "{trial}"));
  CHECK(refused_file(english_with("/screens/next", ""), "/screens/next"));
  CHECK(refused_file(english_with("/instructions/hand", "Stroke."), "drawing:hand"));
  CHECK(refused_file(english_with("/instructions/comfort", "**Stop"), "/instructions/comfort"));
  CHECK_NOTHROW(
      study::parse_language(english_with("/screens/trial_of", "{of}: {trial}").dump(), "xx.json"));
}

TEST_CASE("every protocol has a page of instructions in every language") {
  for (const study::Protocol* protocol : study::protocols()) {
    for (const std::string_view code : study::language_codes()) {
      INFO(protocol->name << " in " << code);
      const study::Texts& texts = study::language_of(code).texts;
      CHECK(texts.at("instructions").contains(std::string(protocol->name)));
    }
  }
}

TEST_CASE("no text of a language names a texture or a method, or tells an outcome in the study") {
  // What practice says about an answer. The study's trials never show it, unless the study of a
  // threshold asks for feedback.
  const std::set<std::string> feedback = {"correct_title", "wrong_title", "it_was",
                                          "it_was_this",   "your_answer", "right_answer"};
  for (const std::string_view code : study::language_codes()) {
    const study::Language& language = study::language_of(code);
    for (const auto& [section, parts] : language.texts) {
      for (const auto& [key, text] : parts) {
        INFO(language.code << " /" << section << "/" << key);
        CHECK((text.find("{label}") == text.npos || feedback.contains(key)));
        for (const char* word : {"{method}", "{class}", "{code}", "{correct}", "{block}",
                                 "adaptive", "gaussian", "Gabor", "bark", "cloth"}) {
          CHECK(text.find(word) == text.npos);
        }
      }
    }
  }
}

TEST_CASE("a study replaces single texts of its language, and only these") {
  const json texts = {{"screens", {{"next", "On"}, {"trial_of", "{trial}/{of}"}}},
                      {"instructions", {{"hand", "Hold **it**.\n\n![](pen.png)"}}}};
  const study::SessionPlan plan = parsed(study_with("en", texts)).session;
  const study::Texts own = study::texts_of(plan);
  CHECK(own.at("screens").at("next") == "On");
  CHECK(own.at("screens").at("back") == study::language_of("en").texts.at("screens").at("back"));
  CHECK(own.at("instructions").at("hand") == "Hold **it**.\n\n![](pen.png)");
  CHECK(study::picture_files(plan) == std::vector<std::string>{"pen.png"});
  study::SessionPlan german = plan;
  german.language = "de";
  CHECK(study::texts_of(german) == study::language_of("de").texts);
  CHECK(study::picture_files(german).empty());
  CHECK(study::to_json(plan)["texts"]["en"] == texts);
}

TEST_CASE("a study's texts are held against the English ones too") {
  CHECK(refused_study({{"screens", {{"nexd", "On"}}}}, "/session/texts/en/screens/nexd"));
  CHECK(refused_study({{"screens", {{"trial_of", "Trial {trial}"}}}}, "{of}"));
  CHECK(refused_study({{"screen", json::object()}}, "screens"));
  CHECK(refused_study({{"instructions", {{"hand", "![](drawing:foot)"}}}}, "drawing:foot"));
  CHECK(refused_study({{"instructions", {{"hand", "Hold **it."}}}},
                      "/session/texts/en/instructions/hand"));
  json document = minimal_study();
  document["session"]["instructions"]["en"] = {"Hold **it."};
  CHECK(refuses<StudyError>([&] { return parsed(document); }, "/session/instructions/en/0"));
}

TEST_CASE("prepare warns of a draft, and names a picture of the instructions that is missing") {
  Laboratory laboratory;
  const auto warnings = [&laboratory] { return laboratory.prepare().warnings; };
  const auto warns = [&] {
    return std::ranges::any_of(warnings(), [](const std::string& warning) {
      return warning.find(study::draft_notice("fr")) != warning.npos;
    });
  };
  CHECK_FALSE(warns());
  laboratory.document["session"]["language"] = "fr";
  CHECK(warns());
  laboratory.document["session"]["instructions"]["fr"] = {"![](pen.png)"};
  const std::string message = message_of<StudyError>(warnings);
  CHECK_THAT(message, names("pen.png"));
  write_noise(laboratory.folder.path() / "pen.png", 1);
  CHECK(warns());
}

TEST_CASE("a study's own texts are not stored in clear, and its size of letters is") {
  json document = study_with("fr", {{"screens", {{"next", "Allons"}}}});
  document["session"]["text_scale"] = 1.25;
  SeededEntropy entropy(1);
  const study::StudyKey key = study::make_study_key(parsed(document), entropy, false);
  const json session = json::parse(study::blinded_configuration(key)).at("session");
  CHECK_FALSE(session.contains("texts"));
  CHECK(session["language"] == "fr");
  CHECK(session["text_scale"] == 1.25);
  CHECK_FALSE(session.contains("high_contrast"));
}

}  // namespace touchtrial
