/// \file What participants answered to questions: the handedness inventory and the closing
/// questions. Answers are sealed, and are opened with outcomes.
#pragma once

#include "analysis/outcomes/demographics.hpp"
#include "analysis/outcomes/sealed_sessions.hpp"
#include "analysis/statistics/descriptive.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::analysis {

/// One answer to one question.
struct QuestionAnswer {
  std::string participant;
  int session = 0;
  std::string questionnaire;       ///< its name, for instance "closing"
  std::string question;            ///< its id
  std::optional<double> number{};  ///< a number, or the index of the chosen option, from 0
  std::string words{};             ///< what was typed; empty for numbers and choices

  friend bool operator==(const QuestionAnswer&, const QuestionAnswer&) = default;
};

/// The answers of all sessions that are not erased, by session and time.
/// \throws VerificationError if an answer does not open
/// \throws StoreError if an answer is not in the form that this program writes
[[nodiscard]] std::vector<QuestionAnswer> open_answers(const StudyEvents& study,
                                                       const SessionKeys& keys);

/// Questions with their wording: the study's own, and those of the program where it knows them.
using Questionnaires = std::vector<study::Questionnaire>;

/// The study file's own questions.
[[nodiscard]] Questionnaires own_questions(const study::Study& study);

/// \return null if the question's wording is unknown
[[nodiscard]] const study::Question* question_of(const Questionnaires& asked,
                                                 const QuestionAnswer& answer);

/// A text in a language, else in English, else in any; empty without one.
[[nodiscard]] std::string in_language(const study::Translated& text, const std::string& language);

/// The text of an answer: the option's text or the typed text; empty for a number.
/// \param question  as question_of; may be null
[[nodiscard]] std::string words_of(const QuestionAnswer& answer, const study::Question* question,
                                   const std::string& language);

/// Whether a question is demographic: age, sex, gender, or the handedness inventory. Demographics
/// report these in bands.
[[nodiscard]] bool is_demographic(const std::string& questionnaire, const std::string& question);

/// Whether an answer could identify a person: free text or an age.
[[nodiscard]] inline bool may_name_somebody(const QuestionAnswer& answer) {
  return !answer.number || answer.question == "age";
}

/// The answers to one question of all participants who count.
struct QuestionSummary {
  std::string question;  ///< its id
  std::string wording;   ///< in the study's language; empty if unknown
  study::QuestionKind kind{};
  int answered = 0;             ///< participants
  std::vector<Band> options{};  ///< of a choice, in their order
  int others = 0;               ///< of a choice, participants whose options are not shown
  Quartiles numbers{};          ///< of a number
  std::vector<std::pair<std::string, std::string>> texts{};  ///< participant, and what was typed
};

struct Outcomes;

/// Summaries of the answers to closing questions, in the order in which they are asked. If a
/// participant had several sessions, the last answer counts. A public report shows no texts, and no
/// options or numbers from fewer than kMinOfBand people.
[[nodiscard]] std::vector<QuestionSummary> summaries_of(const Outcomes& outcomes);

}  // namespace touchtrial::analysis
