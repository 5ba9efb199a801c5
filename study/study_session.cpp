/// \file Describes the study file's "session": its texts, its questions, and its other settings.
#include "core/labels.hpp"
#include "study/languages.hpp"
#include "study/study_sections.hpp"

#include <algorithm>

namespace touchtrial::study {
namespace {

constexpr std::size_t kMaxQuestionBytes = 500;
constexpr std::size_t kMaxPageBytes = 4000;
constexpr std::size_t kMaxNameBytes = 64;

void check_length(const JsonValue& place, const std::string& text, std::size_t max_bytes) {
  if (text.size() <= max_bytes) return;
  place.refuse("has " + std::to_string(text.size()) + " bytes, must have at most " +
               std::to_string(max_bytes) + "; shorten it");
}

constexpr TextRule kPage{.check =
                             [](const JsonValue& place) {
                               const std::string page = read_paragraphs(place, kMaxPageBytes);
                               if (page.empty())
                                 place.refuse("is empty; write a page, or remove it");
                               check_markup(place, page);
                             },
                         .min_length = 1,
                         .max_length = kMaxPageBytes};

void describe_bounds(ObjectIo& io, Question& question) {
  constexpr NumberRange kAny{.low = -1e9, .high = 1e9};
  constexpr auto kKeys = std::to_array<std::string_view>({"min", "max"});
  constexpr auto kOwner = std::to_array<std::string_view>({"number"});
  io.only_for("kind", kOwner, kKeys, "belongs to a question of the kind number; remove it");
  io.number("min", question.min, kAny, {"minimum, shown on the screen; only for `number`"});
  io.number("max", question.max, kAny, {"maximum, shown on the screen; only for `number`"});
  io.rule([&question](const JsonValue& place, const JsonObject& /*object*/) {
    if (!question.min || !question.max || *question.min <= *question.max) return;
    place.refuse_below("/max", "is " + number_text(*question.max) + ", less than min, " +
                                   number_text(*question.min) + "; swap or correct them");
  });
}

void describe_options(ObjectIo& io, Question& question, const std::string& language) {
  constexpr auto kKey = std::to_array<std::string_view>({"options"});
  constexpr auto kOwner = std::to_array<std::string_view>({"choice"});
  io.only_for("kind", kOwner, kKey, "belongs to a question of the kind choice; remove it");
  io.list("options", question.options, {.min = 2, .max = 20},
          {.meaning = "the possible answers, by language; required for `choice`, and only for it",
           .written = !question.options.empty(),
           .default_text = "none"},
          describe_translated);
  io.rule([&](const JsonValue& place, const JsonObject& object) {
    if (question.kind == QuestionKind::choice) static_cast<void>(object.at("options"));
    for (std::size_t i = 0; i < question.options.size(); ++i) {
      require_language(place, "/options/" + std::to_string(i), question.options[i], language);
    }
  });
}

void describe_question(ObjectIo& io, Question& question, const std::string& language) {
  io.text("id", question.id, kPlainName, {.meaning = "unique name in tables", .required = true});
  io.choice("kind", question.kind, kQuestionKindNames,
            {.meaning = "one of the options, a number, or free text", .required = true});
  io.member("text", {.meaning = "the question, by language", .required = true}, true,
            [&question](ValueIo& value) { describe_translated(value, question.text); });
  io.rule([&](const JsonValue& place, const JsonObject& /*object*/) {
    require_language(place, "/text", question.text, language);
  });
  describe_options(io, question, language);
  io.boolean("required", question.required, {"whether the participant must answer it"});
  describe_bounds(io, question);
}

void describe_instructions(ObjectIo& io, SessionPlan& session) {
  describe_by_language(
      io, session.instructions, [](ValueIo& value, std::vector<std::string>& pages) {
        value.list(pages, {.min = 1, .max = 20},
                   [](ValueIo& page, std::string& text) { page.text(text, kPage); });
      });
  io.rule([&session](const JsonValue& place, const JsonObject& /*object*/) {
    if (session.instructions.empty() || session.instructions.contains(session.language)) return;
    place.refuse_below("/" + session.language,
                       "is missing, but is the study's language; add its pages");
  });
}

void describe_replaced_texts(ObjectIo& io, SessionPlan& session) {
  describe_by_language(io, session.texts, [](ValueIo& value, Texts& texts) {
    value.custom(R"({"type": "object"})",
                 [&texts](const JsonValue& place) { texts = read_texts(place); },
                 [&texts] { return nlohmann::json(texts).dump(); });
  });
  std::erase_if(session.texts, [](const auto& entry) { return entry.second.empty(); });
}

/// Describes the texts that the participant reads.
void describe_texts(ObjectIo& io, SessionPlan& session) {
  const std::vector<std::string_view>& codes = language_codes();
  auto language =
      static_cast<std::size_t>(std::ranges::find(codes, session.language) - codes.begin());
  io.member("language",
            {"language of everything that the participant reads, see [Texts and "
             "languages](running-sessions.md#texts-and-languages)"},
            true, [&](ValueIo& value) {
              value.choice(language, codes);
              session.language = codes.at(language);
            });
  io.part("instructions", session,
          {.meaning = "the pages of instructions, by language; none: those of the program. May "
                      "contain bold words and [pictures](running-sessions.md#a-studys-own-texts)",
           .range = "by language"},
          describe_instructions);
  io.part("texts", session,
          {.meaning = "[texts](running-sessions.md#a-studys-own-texts) of the participant's "
                      "screens that replace those of the program",
           .if_changed = true,
           .range = "by language, section and key"},
          describe_replaced_texts);
  io.number("text_scale", session.text_scale, {.low = 1.0, .high = kMaxTextScale},
            {.meaning = "size of the letters on the participant's screens", .if_changed = true});
  io.boolean(
      "high_contrast", session.high_contrast,
      {.meaning = "whether the participant's screens are black on white", .if_changed = true});
}

void describe_masking(ObjectIo& io, MaskingPlan& masking) {
  io.boolean("wanted", masking.wanted,
             {"whether masking noise is played; if so, a session without it has a deviation"});
  io.number("level_dbfs", masking.level_dbfs, {.low = -90.0, .high = 0.0},
            {"root mean square relative to full scale; the laboratory measures the level in dBA"});
}

/// Describes the preparations before a session.
void describe_day(ObjectIo& io, SessionPlan& session) {
  io.list("day_sheet", session.day_sheet, {.max = 50, .unique = true},
          {"items to tick before a session, in addition to the program's own"},
          [](ValueIo& value, std::string& item) { value.text(item, kLine<200>); });
  io.rule([&session](const JsonValue& place, const JsonObject& /*object*/) {
    const std::vector<std::string>& sheet = session.day_sheet;
    for (auto item = sheet.begin(); item != sheet.end(); ++item) {
      if (std::find(sheet.begin(), item, *item) == item) continue;
      place.refuse_below("/day_sheet/" + std::to_string(item - sheet.begin()),
                         in_quotes(*item) + " occurs twice; list it once");
    }
  });
  io.text("consent_version", session.consent_version, kLineOrNothing<kMaxNameBytes>,
          {"version of the consent form that participants sign"});
  io.text("ethics_number", session.ethics_number, kLineOrNothing<kMaxNameBytes>,
          {"number of the ethics committee's approval"});
}

void describe_closing(ObjectIo& io, SessionPlan& session) {
  io.list(
      "closing_questions", session.closing_questions, {.max = 50},
      {.meaning = "questions after the session, in addition to the program's own",
       .range = "0 to 50 entries"},
      [&session](ValueIo& value, Question& question) {
        value.object([&](ObjectIo& keys) { describe_question(keys, question, session.language); });
      });
  io.rule([&session](const JsonValue& place, const JsonObject& /*object*/) {
    const std::vector<Question>& questions = session.closing_questions;
    for (std::size_t i = 0; i < questions.size(); ++i) {
      const auto current = questions.begin() + static_cast<std::ptrdiff_t>(i);
      if (std::ranges::find(questions.begin(), current, current->id, &Question::id) == current)
        continue;
      place.refuse_below(
          "/closing_questions/" + std::to_string(i) + "/id",
          in_quotes(current->id) + " is the id of another question; ids must be unique");
    }
  });
  io.boolean("closing", session.closing,
             {"whether participants answer the program's own closing questions"});
}

}  // namespace

std::string read_line(const JsonValue& place, std::size_t max_bytes) {
  const std::string& line = place.text();
  if (line.empty()) place.refuse("is empty; write a text, or remove the key");
  check_length(place, line, max_bytes);
  if (has_control_character(line)) place.refuse("has a control character; remove it");
  if (line.front() == ' ' || line.back() == ' ') {
    place.refuse("begins or ends with a blank; remove it");
  }
  return line;
}

std::string read_paragraphs(const JsonValue& place, std::size_t max_bytes) {
  const std::string& text = place.text();
  check_length(place, text, max_bytes);
  std::string without_ends = text;
  std::erase(without_ends, '\n');
  if (has_control_character(without_ends)) {
    place.refuse("has a control character other than a line feed; remove it");
  }
  return text;
}

std::string_view words_for_language(std::string_view code) {
  static const std::map<std::string_view, std::string> kWords = [] {
    std::map<std::string_view, std::string> words;
    for (const std::string_view listed_code : language_codes()) {
      const Language& language = language_of(listed_code);
      words[listed_code] = language.name + (language.draft ? ", a draft" : "");
    }
    return words;
  }();
  return kWords.at(code);
}

void describe_translated(ValueIo& io, Translated& text) {
  io.object([&text](ObjectIo& keys) {
    describe_by_language(keys, text, [](ValueIo& value, std::string& line) {
      value.text(line, kLine<kMaxQuestionBytes>);
    });
  });
}

void require_language(const JsonValue& place, const std::string& pointer, const Translated& text,
                      const std::string& language) {
  if (text.contains(language)) return;
  place.refuse_below(pointer + "/" + language, "is missing, but is the study's language; add it");
}

void describe(ObjectIo& io, SessionPlan& session) {
  describe_texts(io, session);
  io.choice("sight", session.sight, kSightNames,
            {"`curtain`: hand and device are hidden and pictures are visible; `blindfold`: the "
             "participant sees nothing, memorises the labels and speaks the answers, which the "
             "experimenter enters"});
  io.part("masking", session.masking, {"noise that masks the device's sound"}, describe_masking);
  io.boolean("handedness", session.handedness,
             {"whether participants answer the handedness inventory"});
  io.integer("confidence", session.confidence_levels, 0, 9,
             {.meaning = "number of levels of confidence for each answer; 0: participants do not "
                         "rate their confidence",
              .unit = "levels",
              .range = "0, 2 to 9"});
  io.rule([&session](const JsonValue& place, const JsonObject& /*object*/) {
    if (session.confidence_levels != 1) return;
    place.refuse_below("/confidence", "is 1, must be 0 (not asked) or from 2 to 9 levels");
  });
  describe_day(io, session);
  describe_closing(io, session);
}

}  // namespace touchtrial::study
