/// \file The sections of the study file: the words in them and what they stand for, their readers,
/// and their JSON form again. For sources only.
#pragma once

#include "core/strict_json.hpp"
#include "protocols/design/study.hpp"

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial::design {

inline constexpr std::array kTrialOrderNames = {
    Named<TrialOrder>{"shuffled", TrialOrder::shuffled},
    Named<TrialOrder>{"de-bruijn", TrialOrder::de_bruijn},
    Named<TrialOrder>{"uniform", TrialOrder::uniform},
    Named<TrialOrder>{"williams", TrialOrder::williams}};

inline constexpr std::array kOnTimeoutNames = {
    Named<OnTimeout>{"fade", OnTimeout::fade},
    Named<OnTimeout>{"no-response", OnTimeout::no_response}};

inline constexpr std::array kBlocksNames = {Named<Blocks>{"by-method", Blocks::by_method},
                                            Named<Blocks>{"mixed", Blocks::mixed}};

inline constexpr std::array kOnInterruptionNames = {
    Named<OnInterruption>{"repeat", OnInterruption::repeat},
    Named<OnInterruption>{"leave-out", OnInterruption::leave_out},
    Named<OnInterruption>{"restart-block", OnInterruption::restart_block}};

inline constexpr std::array kSightNames = {Named<Sight>{"curtain", Sight::curtain},
                                           Named<Sight>{"blindfold", Sight::blindfold}};

inline constexpr std::array kQuestionKindNames = {
    Named<QuestionKind>{"choice", QuestionKind::choice},
    Named<QuestionKind>{"number", QuestionKind::number},
    Named<QuestionKind>{"text", QuestionKind::text}};

inline constexpr std::array kModelNames = {
    Named<engine::ModelKind>{"paper", engine::ModelKind::paper},
    Named<engine::ModelKind>{"surface", engine::ModelKind::surface}};

inline constexpr std::array kEqualiseNames = {
    Named<engine::Equalise>{"none", engine::Equalise::none},
    Named<engine::Equalise>{"rms", engine::Equalise::rms}};

/// The word for a value; every value of the enumeration is in its table.
template <typename Value, std::size_t size>
[[nodiscard]] constexpr std::string_view word_for(const std::array<Named<Value>, size>& table,
                                                  Value value) {
  for (const Named<Value>& entry : table) {
    if (entry.value == value) return entry.name;
  }
  return {};
}

/// The languages that the program's own texts come in, and so those of a study's.
inline constexpr std::array<std::string_view, 2> kLanguages = {"en", "de"};

/// Whether a text has C0 (a line's end and a tab count too), DEL, or C1.
[[nodiscard]] bool has_control_character(std::string_view text);

/// One line, without blanks at its ends. \param longest  bytes
/// \throws StudyError if it is longer, or is empty, or has a control character
[[nodiscard]] std::string read_line(const JsonValue& place, std::size_t longest);

/// Paragraphs: may have line ends and be empty. \throws StudyError as above
[[nodiscard]] std::string read_paragraphs(const JsonValue& place, std::size_t longest);

/// A line in some of the languages. \throws StudyError if the study's language is not among them
[[nodiscard]] Translated read_translated(const JsonValue& place, const std::string& language);

/// What a study may have at most. The limits keep schedules, packs and pictures of a size that one
/// participant, one disk and one screen can take.
inline constexpr std::size_t kMaxClasses = 64;
inline constexpr std::size_t kMaxImagesOfClass = 1000;
inline constexpr std::size_t kMaxMethods = 8;
inline constexpr int kMaxStimuli = 10'000;
inline constexpr int kMaxScoredTrials = 10'000;

/// A text that may stand in file names, tables and BIDS labels: 1 to 64 of 0-9 A-Z a-z _ -
/// \throws StudyError if it is not such
[[nodiscard]] std::string read_plain_name(const JsonValue& place);

/// All throw StudyError with the place of what they cannot accept.
[[nodiscard]] std::vector<StudyClass> read_classes(const JsonValue& place,
                                                   std::size_t most_images = kMaxImagesOfClass);
[[nodiscard]] std::vector<StudyMethod> read_methods(const JsonValue& place);
[[nodiscard]] engine::RenderingOptions read_rendering(const JsonValue& place);
[[nodiscard]] TrialOptions read_trials(const JsonValue& place);
[[nodiscard]] PracticePlan read_practice(const JsonValue& place);
[[nodiscard]] SessionPlan read_session(const JsonValue& place);
[[nodiscard]] Registration read_registration(const JsonValue& place);

/// The sections as the study file writes them, every key explicit; a method has the keys that
/// belong to it and no others, "control" if it has one, and "label" if it is not the default. Of
/// the trials, "max_run", "on_interruption" and "resume_within_h" are there only where they are not
/// the default, so that what was sealed before they existed stays as it was. Equal options give
/// equal JSON.
[[nodiscard]] nlohmann::json to_json(const engine::ExtractionOptions& method);
[[nodiscard]] nlohmann::json to_json(const StudyMethod& method);
[[nodiscard]] nlohmann::json to_json(const engine::RenderingOptions& rendering);
[[nodiscard]] nlohmann::json to_json(const TrialOptions& trials);
[[nodiscard]] nlohmann::json to_json(const PracticePlan& practice);
[[nodiscard]] nlohmann::json to_json(const SessionPlan& session);
[[nodiscard]] nlohmann::json to_json(const Registration& registration);

/// Questions of the study file.
/// \param language  the study's: every text must have it
/// \throws StudyError with the place of what it cannot accept
[[nodiscard]] std::vector<Question> read_questions(const JsonValue& place,
                                                   const std::string& language);

/// As the study file writes them, every key explicit but "options" where there are none.
[[nodiscard]] nlohmann::json to_json(const std::vector<Question>& questions);

}  // namespace touchtrial::design
