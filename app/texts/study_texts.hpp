/// \file The texts of a study: the program's own in its language, and what the study file gives.
/// docs/experimenter.md says where questions and items come from.
#pragma once

#include "protocols/design/study.hpp"
#include "protocols/session/session_texts.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

/// The study's pages of instruction take the place of the program's, in languages that it has them
/// in; its closing questions and day-sheet items stand after the program's own, and a question with
/// the id of one of these in its place. English where the program has not the study's language.
[[nodiscard]] session::SessionTexts session_texts(const design::Study& study);

/// Day-sheet items for the time after the participant has left.
[[nodiscard]] std::vector<session::DaySheetItem> day_sheet_after(const design::Study& study);

/// Laterality quotient of the short form of the Edinburgh inventory; source: Veale (2014),
/// Laterality 19, 164-177.
/// \param answers  a reply to the questionnaire "handedness": options as indices from 0
/// \return from -100 (left) to 100 (right); nothing if one of the four items was left out
[[nodiscard]] std::optional<double> laterality_quotient(const std::vector<std::string>& answers);

}  // namespace touchtrial::app
