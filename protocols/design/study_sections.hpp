/// \file Readers of the study file's sections, and their JSON form again. For sources only.
#pragma once

#include "core/strict_json.hpp"
#include "protocols/design/study.hpp"

#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial::design {

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

}  // namespace touchtrial::design
