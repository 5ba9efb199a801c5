/// \file The sections of the study file: their keys, the names of their values, and functions that
/// write them as JSON. Include only from source files.
#pragma once

#include "core/describe.hpp"
#include "study/languages.hpp"
#include "study/study.hpp"

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial::study {

inline constexpr auto kTrialOrderNames =
    std::to_array<Named<TrialOrder>>({{"shuffled", TrialOrder::shuffled},
                                      {"de-bruijn", TrialOrder::de_bruijn},
                                      {"uniform", TrialOrder::uniform},
                                      {"williams", TrialOrder::williams}});

inline constexpr auto kOnTimeoutNames = std::to_array<Named<OnTimeout>>(
    {{"fade", OnTimeout::fade}, {"no-response", OnTimeout::no_response}});

inline constexpr auto kBlocksNames =
    std::to_array<Named<Blocks>>({{"by-method", Blocks::by_method}, {"mixed", Blocks::mixed}});

inline constexpr auto kOnInterruptionNames =
    std::to_array<Named<OnInterruption>>({{"repeat", OnInterruption::repeat},
                                          {"leave-out", OnInterruption::leave_out},
                                          {"restart-block", OnInterruption::restart_block}});

inline constexpr auto kSightNames =
    std::to_array<Named<Sight>>({{"curtain", Sight::curtain}, {"blindfold", Sight::blindfold}});

inline constexpr auto kQuestionKindNames =
    std::to_array<Named<QuestionKind>>({{"choice", QuestionKind::choice},
                                        {"number", QuestionKind::number},
                                        {"text", QuestionKind::text}});

inline constexpr auto kModelNames = std::to_array<Named<engine::ModelKind>>(
    {{"paper", engine::ModelKind::paper}, {"surface", engine::ModelKind::surface}});

inline constexpr auto kEqualiseNames =
    std::to_array<Named<engine::Equalise>>({{"none", engine::Equalise::none},
                                            {"rms", engine::Equalise::rms},
                                            {"level", engine::Equalise::level}});

inline constexpr auto kEstimandNames =
    std::to_array<Named<Estimand>>({{"mean-accuracy", Estimand::mean_accuracy},
                                    {"difference", Estimand::difference},
                                    {"mean-threshold", Estimand::mean_threshold},
                                    {"threshold-difference", Estimand::threshold_difference},
                                    {"threshold-equality", Estimand::threshold_equality}});

inline constexpr auto kRegisteredTestNames =
    std::to_array<Named<RegisteredTest>>({{"t", RegisteredTest::t},
                                          {"sign-flip", RegisteredTest::sign_flip},
                                          {"crossover", RegisteredTest::crossover}});

inline constexpr auto kSidesNames = std::to_array<Named<bool>>({{"one", true}, {"two", false}});

inline constexpr auto kVisitMethodsNames = std::to_array<Named<VisitMethods>>(
    {{"all", VisitMethods::all}, {"divided", VisitMethods::divided}});

inline constexpr auto kRegisteredVisitsNames =
    std::to_array<Named<RegisteredVisits>>({{"all", RegisteredVisits::all},
                                            {"first", RegisteredVisits::first},
                                            {"last", RegisteredVisits::last}});

inline constexpr auto kSpendingNames = std::to_array<Named<Spending>>(
    {{"obrien-fleming", Spending::obrien_fleming}, {"pocock", Spending::pocock}});

/// Reads one line.
/// \param max_bytes  maximum length
/// \throws StudyError if the line is empty or too long, begins or ends with a blank, or contains a
///   control character
[[nodiscard]] std::string read_line(const JsonValue& place, std::size_t max_bytes);

/// Reads paragraphs, which may contain line feeds and may be empty.
/// \throws StudyError if the text is too long, or contains another control character
[[nodiscard]] std::string read_paragraphs(const JsonValue& place, std::size_t max_bytes);

/// A line of 1 to `max_bytes` bytes.
template <std::size_t max_bytes>
inline constexpr TextRule kLine{
    .check = [](const JsonValue& place) { static_cast<void>(read_line(place, max_bytes)); },
    .min_length = 1,
    .max_length = max_bytes};
/// A line of 0 to `max_bytes` bytes.
template <std::size_t max_bytes>
inline constexpr TextRule kLineOrNothing{.check =
                                             [](const JsonValue& place) {
                                               if (!place.text().empty())
                                                 static_cast<void>(read_line(place, max_bytes));
                                             },
                                         .max_length = max_bytes};
template <std::size_t max_bytes>
inline constexpr TextRule kParagraphs{
    .check = [](const JsonValue& place) { static_cast<void>(read_paragraphs(place, max_bytes)); },
    .max_length = max_bytes};

/// "German", "French, a draft"
[[nodiscard]] std::string_view words_for_language(std::string_view code);

/// Describes a key for each of the program's languages.
/// \param describe  (ValueIo&, Value&)
template <typename Value, typename Describe>
void describe_by_language(ObjectIo& io, std::map<std::string, Value>& values,
                          const Describe& describe) {
  for (const std::string_view code : language_codes()) {
    std::optional<Value> value;
    if (const auto found = values.find(std::string(code)); found != values.end()) {
      value = found->second;
    }
    io.optional(code, value, {.meaning = words_for_language(code)}, describe);
    if (value) values[std::string(code)] = *value;
  }
}
/// Describes a line in one or more languages.
void describe_translated(ValueIo& io, Translated& text);
/// \param pointer  JSON pointer to `text`, relative to `place`
/// \throws StudyError if the study's language is missing
void require_language(const JsonValue& place, const std::string& pointer, const Translated& text,
                      const std::string& language);

/// Upper limits of a study. They keep schedules, packs and pictures small enough for one
/// participant, one disk and one screen.
inline constexpr std::size_t kMaxClasses = 64;
inline constexpr std::size_t kMaxImagesOfClass = 1000;
inline constexpr std::size_t kMaxMethods = 8;
inline constexpr int kMaxStimuli = 10'000;
inline constexpr int kMaxScoredTrials = 10'000;

/// Reads a name that is safe in file names, tables and BIDS labels: 1 to 64 of 0-9 A-Z a-z _ -, and
/// not a word that other programs read as a missing value.
/// \throws StudyError if the text is not such a name
[[nodiscard]] std::string read_plain_name(const JsonValue& place);

inline constexpr TextRule kPlainName{
    .check = [](const JsonValue& place) { static_cast<void>(read_plain_name(place)); },
    .pattern = "^[0-9A-Za-z_-]{1,64}$",
    .description = "1 to 64 of `0-9 A-Z a-z _ -`"};

/// Refuses a label that equals or looks like another one (skeleton_of).
/// \param pointer  JSON pointer to the label
/// \param category  what the labels name, for instance "class"
/// \throws StudyError with the place
void refuse_same_label(const JsonValue& place, const std::string& pointer, const std::string& label,
                       const std::string& other, const std::string& category);

/// The content of "rendering".
struct RenderingSection {
  engine::RenderingOptions options;
  std::string device;                ///< Study::device
  std::optional<TargetLevel> level;  ///< Study::level
};

/// These functions describe the sections, and refuse values that contradict each other.
void describe_classes(ObjectIo& io, std::vector<StudyClass>& classes, int min_classes,
                      std::size_t max_images, const KeyInfo& info);
void describe_methods(ObjectIo& io, std::vector<StudyMethod>& methods, const KeyInfo& info);
void describe(ObjectIo& io, RenderingSection& rendering);
void describe(ObjectIo& io, TrialOptions& trials);
void describe(ObjectIo& io, PracticePlan& practice);
void describe(ObjectIo& io, SessionPlan& session);
void describe(ObjectIo& io, VisitPlan& visits);
void describe(ObjectIo& io, GroupPlan& groups);
/// \param default_test  default_test_of the study
void describe(ObjectIo& io, Registration& registration, RegisteredTest default_test);
/// Checks that the registered analysis is possible for this study.
/// \param file  the study file
void check_registration(const JsonValue& file, const Study& study);

/// Writes a section in the form of the study file. It has every key, with these exceptions: a
/// method has only the keys that belong to it, "control" if it has one, and "label" if it is not
/// the default. So that older studies keep their seals, keys that were added later appear only if
/// they differ from their defaults (KeyInfo::if_changed), and a registration has the keys of an
/// analysis only if it has one. Equal options give equal JSON.
[[nodiscard]] nlohmann::json written_section(const Description& section,
                                             const Description& defaults);
template <typename Section>
[[nodiscard]] nlohmann::json to_json(const Section& section) {
  Section copy = section;
  Section defaults;
  return written_section([&](ObjectIo& io) { describe(io, copy); },
                         [&](ObjectIo& io) { describe(io, defaults); });
}
[[nodiscard]] nlohmann::json to_json(const engine::ExtractionOptions& method);
[[nodiscard]] nlohmann::json to_json(const StudyMethod& method);
[[nodiscard]] nlohmann::json to_json(const engine::RenderingOptions& rendering);
[[nodiscard]] nlohmann::json to_json(const Registration& registration);

}  // namespace touchtrial::study
