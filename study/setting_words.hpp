/// \file Settings of a study in words: noun phrases that the preregistration page and the methods
/// of a report share, so that both say the same of a setting. Numbers have their units; nothing
/// here names an image, a code or a seed. Thread-safe.
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
/// Every method that is presented, by its label.
[[nodiscard]] SettingFields fields_of_methods(const Study& study);

/// "0.4 N/mm, without damping"
[[nodiscard]] std::string wall_words(const engine::RenderingOptions& rendering);
/// How heights become forces, with its parameters, for one of the rendering models.
[[nodiscard]] std::string force_words(const engine::RenderingOptions& rendering);
/// How the reconstruction filter smooths heights; "none" without one.
[[nodiscard]] std::string filter_words(const engine::RenderingOptions& rendering);
/// From where gains come: stated, from the stiffness budget, or from a level above threshold; and
/// whether stimuli are equalised.
[[nodiscard]] std::string gain_words(const Study& study);
/// All of these.
[[nodiscard]] SettingFields fields_of_rendering(const Study& study);

/// When a trial is valid.
[[nodiscard]] SettingFields fields_of(const ValidityRule& rule);
/// "at least 0.5 s at the plane and 25 mm along it, unless time is up"; "no touch needed".
[[nodiscard]] std::string touch_words(const LeastTouch& touch);
/// "20 to 300 mm/s and 0.15 to 2.5 N"
[[nodiscard]] std::string range_words(const HandRange& range);
/// Presentations of a round, of what, the criterion and the most rounds; "none" without practice.
[[nodiscard]] std::string practice_words(const Study& study);
/// "3, at least 1 and at most 7 days between them, all methods at each"; empty for one visit.
[[nodiscard]] std::string visits_words(const VisitPlan& visits);
/// The language of the participants' texts, with what has to be said of a draft.
[[nodiscard]] std::string language_words(const SessionPlan& session);
/// What participants see of pictures, hand and device.
[[nodiscard]] std::string sight_words(const Study& study);
/// "white noise at -30 dB re full scale (rms)"; "none".
[[nodiscard]] std::string masking_words(const MaskingPlan& masking);

}  // namespace touchtrial::study
