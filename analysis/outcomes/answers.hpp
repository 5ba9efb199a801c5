/// \file Participants' answers to questions: the handedness inventory and the closing questions.
/// Answers are sealed, and are opened together with outcomes.
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
  std::string questionnaire;       ///< name, for instance "closing"
  std::string question;            ///< id
  std::optional<double> number{};  ///< a number, or the index of the chosen option, from 0
  std::string words{};             ///< typed text; empty for numbers and choices

  friend bool operator==(const QuestionAnswer&, const QuestionAnswer&) = default;
};

/// The answers of all unerased sessions, by session and time.
/// \throws VerificationError if an answer does not open
/// \throws StoreError if an answer has a form that this program does not write
[[nodiscard]] std::vector<QuestionAnswer> open_answers(const StudyEvents& study,
                                                       const SessionKeys& keys);

/// Questions with their wording, from the study or from the program.
using Questionnaires = std::vector<study::Questionnaire>;

/// The closing questions of the study file.
[[nodiscard]] Questionnaires closing_questionnaires(const study::Study& study);

/// \return null if the question's wording is unknown
[[nodiscard]] const study::Question* question_of(const Questionnaires& questionnaires,
                                                 const QuestionAnswer& answer);

/// A text in a language, otherwise in English, otherwise in any language; may be empty.
[[nodiscard]] std::string in_language(const study::Translated& text, const std::string& language);

/// The text of an answer: the option's text or the typed text; empty for a number.
/// \param question  from question_of; may be null
[[nodiscard]] std::string words_of(const QuestionAnswer& answer, const study::Question* question,
                                   const std::string& language);

/// Whether a question is demographic: age, sex, gender, or the handedness inventory. Reports show
/// these in bands.
[[nodiscard]] bool is_demographic(const std::string& questionnaire, const std::string& question);

/// Whether an answer could identify a person: free text or an age.
[[nodiscard]] inline bool may_identify_person(const QuestionAnswer& answer) {
  return !answer.number || answer.question == "age";
}

/// All counted participants' answers to one question.
struct QuestionSummary {
  std::string question;  ///< id
  std::string wording;   ///< in the study's language; empty if unknown
  study::QuestionKind kind{};
  int answered = 0;             ///< number of participants
  std::vector<Band> options{};  ///< for choices, in the question's order
  int others = 0;               ///< for choices, participants whose options are not shown
  Quartiles numbers{};          ///< for numbers
  std::vector<std::pair<std::string, std::string>> texts{};  ///< participant and typed text
};

struct Outcomes;

/// Summaries of the answers to closing questions, in the order of the questions. If a participant
/// had several sessions, the last answer counts. A public report shows no texts, and no options or
/// numbers from fewer than kMinBandPeople people.
[[nodiscard]] std::vector<QuestionSummary> question_summaries(const Outcomes& outcomes);

}  // namespace touchtrial::analysis
