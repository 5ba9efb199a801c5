/// \file The texts that people read in a session: those of the study's language, and the study's own
/// in their place. Sources of questions and items: docs/running-sessions.md.
#pragma once

#include "protocols/session/session_stages.hpp"
#include "study/study.hpp"

namespace touchtrial::app {

/// The study's pages of instructions replace the program's in the languages that have them. Its
/// closing questions and day-sheet items follow the program's; a question with the id of one of the
/// program's replaces it. Texts are English if the program does not have the study's language.
[[nodiscard]] session::SessionTexts session_texts(const study::Study& study);

/// The questionnaires of these texts, worded in the study's language alone: no other language's
/// file is read.
[[nodiscard]] std::vector<study::Questionnaire> questionnaires_of(const study::Study& study);

}  // namespace touchtrial::app
