/// The study file's "session".
#include "protocols/design/study_names.hpp"
#include "protocols/design/study_questions.hpp"
#include "protocols/design/study_sections.hpp"
#include "protocols/design/study_texts.hpp"

#include <algorithm>

namespace touchtrial::design {
namespace {

constexpr std::size_t kMostPages = 20;
constexpr std::size_t kLongestPage = 4000;  // bytes
constexpr std::size_t kMostItems = 50;
constexpr std::size_t kLongestItem = 200;  // bytes
constexpr std::size_t kLongestName = 64;   // bytes

void read_truth(const JsonObject& object, std::string_view key, bool& truth) {
  if (const auto member = object.find(key)) truth = member->truth();
}

std::vector<std::string> read_pages(const JsonValue& place) {
  std::vector<std::string> pages;
  for (const JsonValue& item : place.items(1, kMostPages)) {
    pages.push_back(read_paragraphs(item, kLongestPage));
    if (pages.back().empty()) item.refuse("is empty; write a page, or remove it");
  }
  return pages;
}

void read_instructions(const JsonValue& place, SessionPlan& session) {
  const JsonObject object = place.object(kLanguages);
  for (const std::string_view code : kLanguages) {
    if (const auto member = object.find(code)) {
      session.instructions[std::string(code)] = read_pages(*member);
    }
  }
  if (!session.instructions.empty() && !session.instructions.contains(session.language)) {
    place.refuse_below("/" + session.language, "is missing, the study's language; add its pages");
  }
}

MaskingPlan read_masking(const JsonValue& place) {
  const JsonObject object = place.object({"wanted", "level_dbfs"});
  MaskingPlan masking;
  read_truth(object, "wanted", masking.wanted);
  if (const auto member = object.find("level_dbfs")) {
    masking.level_dbfs = member->number({.low = -90.0, .high = 0.0});
  }
  return masking;
}

int read_confidence(const JsonValue& place) {
  constexpr int kMostLevels = 9;
  const auto levels = static_cast<int>(place.integer(0, kMostLevels));
  if (levels == 1) place.refuse("is 1, must be 0 (not asked) or from 2 to 9 levels");
  return levels;
}

std::vector<std::string> read_day_sheet(const JsonValue& place) {
  std::vector<std::string> sheet;
  for (const JsonValue& item : place.items(0, kMostItems)) {
    std::string line = read_line(item, kLongestItem);
    if (std::ranges::count(sheet, line) > 0) {
      item.refuse(in_quotes(line) + " is there twice; list it once");
    }
    sheet.push_back(std::move(line));
  }
  return sheet;
}

/// A version or a number: a line that may be empty.
void read_name(const JsonObject& object, std::string_view key, std::string& name) {
  const auto member = object.find(key);
  if (member && !member->text().empty()) name = read_line(*member, kLongestName);
}

}  // namespace

SessionPlan read_session(const JsonValue& place) {
  const JsonObject object = place.object(
      {"language", "instructions", "sight", "masking", "handedness", "confidence", "day_sheet",
       "consent_version", "ethics_number", "closing_questions", "closing"});
  SessionPlan session;
  if (const auto member = object.find("language")) {
    session.language = kLanguages[member->choice(std::span(kLanguages))];
  }
  if (const auto member = object.find("instructions")) read_instructions(*member, session);
  if (const auto member = object.find("sight")) session.sight = member->choice(kSightNames);
  if (const auto member = object.find("masking")) session.masking = read_masking(*member);
  read_truth(object, "handedness", session.handedness);
  if (const auto member = object.find("confidence")) {
    session.confidence_levels = read_confidence(*member);
  }
  if (const auto member = object.find("day_sheet")) session.day_sheet = read_day_sheet(*member);
  read_name(object, "consent_version", session.consent_version);
  read_name(object, "ethics_number", session.ethics_number);
  if (const auto member = object.find("closing_questions")) {
    session.closing_questions = read_questions(*member, session.language);
  }
  read_truth(object, "closing", session.closing);
  return session;
}

nlohmann::json to_json(const SessionPlan& session) {
  nlohmann::json instructions = nlohmann::json::object();
  for (const auto& [language, pages] : session.instructions) instructions[language] = pages;
  return {
      {"language", session.language},
      {"instructions", instructions},
      {"sight", word_for(kSightNames, session.sight)},
      {"masking", {{"wanted", session.masking.wanted}, {"level_dbfs", session.masking.level_dbfs}}},
      {"handedness", session.handedness},
      {"confidence", session.confidence_levels},
      {"day_sheet", session.day_sheet},
      {"consent_version", session.consent_version},
      {"ethics_number", session.ethics_number},
      {"closing_questions", to_json(session.closing_questions)},
      {"closing", session.closing}};
}

}  // namespace touchtrial::design
