/// \file Settings of a study in words: noun phrases shared by the preregistration page and the
/// methods of a report, so that both describe a setting in the same way. Numbers have units, and no
/// text contains an image, a code or a seed. Thread-safe.
#pragma once

#include "study/ask.hpp"
#include "study/study.hpp"

#include <string>
#include <utility>
#include <vector>

namespace touchtrial::study {

/// Names of settings and their values in words.
using SettingFields = std::vector<std::pair<std::string, std::string>>;

/// An extraction method with its parameters: "adaptive fractional differential (K = 2, ...)".
[[nodiscard]] std::string words_of(const engine::ExtractionOptions& method);
/// Every presented method, by its label.
[[nodiscard]] SettingFields fields_of_methods(const Study& study);

/// "0.4 N/mm, without damping"
[[nodiscard]] std::string wall_words(const engine::RenderingOptions& rendering);
/// How the rendering model computes forces from heights, with its parameters.
[[nodiscard]] std::string force_words(const engine::RenderingOptions& rendering);
/// How the reconstruction filter smooths heights; "none" without one.
[[nodiscard]] std::string filter_words(const engine::RenderingOptions& rendering);
/// The source of the gains (explicit, stiffness budget, or level above threshold), and whether
/// stimuli are equalised.
[[nodiscard]] std::string gain_words(const Study& study);
/// All settings of the rendering.
[[nodiscard]] SettingFields fields_of_rendering(const Study& study);

/// The conditions for a valid trial.
[[nodiscard]] SettingFields fields_of(const ValidityRule& rule);
/// "at least 0.5 s at the plane and 25 mm along it, unless time is up"; "no touch needed".
[[nodiscard]] std::string touch_words(const MinTouch& touch);
/// "20 to 300 mm/s and 0.15 to 2.5 N"
[[nodiscard]] std::string range_words(const HandRange& range);
/// Presentations per round, their textures, the criterion and the maximum of rounds; "none" without
/// practice.
[[nodiscard]] std::string practice_words(const Study& study);
/// "3, at least 1 and at most 7 days between them, all methods at each"; empty for one visit.
[[nodiscard]] std::string visits_words(const VisitPlan& visits);
/// The language of the participants' texts, with draft_notice().
[[nodiscard]] std::string language_words(const SessionPlan& session);
/// What participants can see of pictures, hand and device.
[[nodiscard]] std::string sight_words(const Study& study);
/// "pink noise at -30 dB re full scale (rms)" or "none"
[[nodiscard]] std::string masking_words(const MaskingPlan& masking);

}  // namespace touchtrial::study
