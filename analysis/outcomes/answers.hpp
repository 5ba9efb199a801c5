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

/// The answers of all sessions that are not erased, by session and by when they were given.
/// \throws VerificationError if an answer does not open
/// \throws StoreError if an answer is not in the form that this program writes
[[nodiscard]] std::vector<QuestionAnswer> open_answers(const StudyEvents& study,
                                                       const SessionKeys& keys);

/// Questions with their wording: the study's own, and those of the program where it knows them.
using Questionnaires = std::vector<study::Questionnaire>;

/// The study file's own questions.
[[nodiscard]] Questionnaires own_questions(const study::Study& study);

/// \return null if nobody knows the question's wording
[[nodiscard]] const study::Question* question_of(const Questionnaires& asked,
                                                 const QuestionAnswer& answer);

/// A text in a language, else in English, else in any; empty without one.
[[nodiscard]] std::string in_language(const study::Translated& text, const std::string& language);

/// An answer as people read it: the option's text, or what was typed; empty for a number.
/// \param question  as question_of; may be null
[[nodiscard]] std::string words_of(const QuestionAnswer& answer, const study::Question* question,
                                   const std::string& language);

/// Whether a question asks who somebody is: age, sex, gender, or the handedness inventory.
/// Demographics tell about these, in bands.
[[nodiscard]] bool is_demographic(const std::string& questionnaire, const std::string& question);

/// Whether an answer is in words, which may name somebody, or an age.
[[nodiscard]] inline bool may_name_somebody(const QuestionAnswer& answer) {
  return !answer.number || answer.question == "age";
}

/// The answers of all participants who count to one question.
struct QuestionSummary {
  std::string question;  ///< its id
  std::string wording;   ///< in the study's language; empty if nobody knows it
  study::QuestionKind kind{};
  int answered = 0;             ///< participants
  std::vector<Band> options{};  ///< of a choice, in their order
  int others = 0;               ///< of a choice, participants whose options are not shown
  Quartiles numbers{};          ///< of a number
  std::vector<std::pair<std::string, std::string>> texts{};  ///< participant, and what was typed
};

struct Outcomes;

/// What participants said in answer to closing questions, by question, in the order in which they
/// are asked. Of several sessions, a participant's last answer counts. A public report shows no
/// texts, and neither options that fewer than kMinOfBand people chose nor numbers of so few.
[[nodiscard]] std::vector<QuestionSummary> summaries_of(const Outcomes& outcomes);

}  // namespace touchtrial::analysis
