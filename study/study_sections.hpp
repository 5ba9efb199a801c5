/// \file The sections of the study file: the words that they use, functions that read them, and
/// functions that write them as JSON. Include only from source files.
#pragma once

#include "core/strict_json.hpp"
#include "study/study.hpp"

#include <array>
#include <cstddef>
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
/// \param longest  maximum length, bytes
/// \throws StudyError if the line is too long, is empty, begins or ends with a blank, or has a
///   control character
[[nodiscard]] std::string read_line(const JsonValue& place, std::size_t longest);

/// Reads paragraphs, which may contain line feeds and may be empty.
/// \throws StudyError if the text is too long, or has another control character
[[nodiscard]] std::string read_paragraphs(const JsonValue& place, std::size_t longest);

/// Reads a line in one or more of the program's languages.
/// \throws StudyError if the study's language is missing
[[nodiscard]] Translated read_translated(const JsonValue& place, const std::string& language);
/// The same in any languages.
[[nodiscard]] Translated read_translated(const JsonValue& place);

/// Upper limits of a study. They keep schedules, packs and pictures small enough for one
/// participant, one disk and one screen.
inline constexpr std::size_t kMaxClasses = 64;
inline constexpr std::size_t kMaxImagesOfClass = 1000;
inline constexpr std::size_t kMaxMethods = 8;
inline constexpr int kMaxStimuli = 10'000;
inline constexpr int kMaxScoredTrials = 10'000;

/// Reads a name that is safe in file names, tables and BIDS labels: 1 to 64 of 0-9 A-Z a-z _ -, and
/// no word that other programs take for a missing value.
/// \throws StudyError if the text is not such a name
[[nodiscard]] std::string read_plain_name(const JsonValue& place);

/// Refuses a label that another one equals or looks like (skeleton_of).
/// \param of  what has labels: "class"
/// \throws StudyError with the place
void refuse_same_label(const JsonValue& place, const std::string& label, const std::string& other,
                       const std::string& of);

/// These functions read one section each.
/// \throws StudyError with the place of a value that they do not accept
/// \param fewest  classes
[[nodiscard]] std::vector<StudyClass> read_classes(const JsonValue& place, int fewest,
                                                   std::size_t most_images = kMaxImagesOfClass);
[[nodiscard]] std::vector<StudyMethod> read_methods(const JsonValue& place);
struct ReadRendering {
  engine::RenderingOptions options;
  std::string device;                ///< Study::device
  std::optional<WantedLevel> level;  ///< Study::level
};
[[nodiscard]] ReadRendering read_rendering(const JsonValue& place);
[[nodiscard]] TrialOptions read_trials(const JsonValue& place);
[[nodiscard]] PracticePlan read_practice(const JsonValue& place);
[[nodiscard]] SessionPlan read_session(const JsonValue& place);
[[nodiscard]] VisitPlan read_visits(const JsonValue& place);
[[nodiscard]] GroupPlan read_groups(const JsonValue& place);
/// \param usual_test  of a difference in this study
[[nodiscard]] Registration read_registration(const JsonValue& place, RegisteredTest usual_test);
/// Checks that the registered analysis is one of this study.
/// \param file  the whole study file
void check_registration(const JsonValue& file, const Study& study);

/// The sections in the form of the study file, with every key explicit. A method has only the keys
/// that belong to it, "control" if it has one, and "label" if it is not the default. The trials
/// have "max_run", "rove_db", "on_interruption", "resume_within_h", "validity" and "answer_after"
/// only if these differ from their defaults, as the session has "texts", "text_scale" and
/// "high_contrast", and a registration has the keys of its analysis only if it has one, so that
/// studies sealed before these keys existed keep their seals. Equal options give equal JSON.
[[nodiscard]] nlohmann::json to_json(const engine::ExtractionOptions& method);
[[nodiscard]] nlohmann::json to_json(const StudyMethod& method);
[[nodiscard]] nlohmann::json to_json(const engine::RenderingOptions& rendering);
[[nodiscard]] nlohmann::json to_json(const TrialOptions& trials);
[[nodiscard]] nlohmann::json to_json(const PracticePlan& practice);
[[nodiscard]] nlohmann::json to_json(const SessionPlan& session);
[[nodiscard]] nlohmann::json to_json(const VisitPlan& visits);
[[nodiscard]] nlohmann::json to_json(const GroupPlan& groups);
[[nodiscard]] nlohmann::json to_json(const Registration& registration);

/// Reads the questions of the study file.
/// \param language  the study's language, in which every text must exist
/// \throws StudyError with the place of a value that is not accepted
[[nodiscard]] std::vector<Question> read_questions(const JsonValue& place,
                                                   const std::string& language);

/// The questions in the form of the study file, with every key explicit except empty "options" and
/// bounds that are not given.
[[nodiscard]] nlohmann::json to_json(const std::vector<Question>& questions);

}  // namespace touchtrial::study
