/// \file The texts of a session: those of the study's language, overridden by the study's own.
///   Sources of questions and items: docs/running-sessions.md.
#pragma once

#include "protocols/session/session_stages.hpp"
#include "study/study.hpp"

namespace touchtrial::app {

/// The study's instruction pages replace the built-in ones in the languages that have them. Its
/// closing questions and day-sheet items follow the built-in ones; a question with a built-in id
/// replaces that one. Texts are English if the study's language is not available.
[[nodiscard]] session::SessionTexts session_texts(const study::Study& study);

/// The questionnaires of these texts, only in the study's language: no other language file is read.
[[nodiscard]] std::vector<study::Questionnaire> questionnaires_of(const study::Study& study);

}  // namespace touchtrial::app
