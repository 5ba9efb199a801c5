/// \file The sessions and participants in a BIDS dataset, and the names of their files. Private to
/// exports.
#pragma once

#include "analysis/exports/data_table.hpp"
#include "analysis/exports/dataset.hpp"
#include "analysis/outcomes/collection.hpp"

#include <chrono>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// A session in the dataset.
struct BidsSession {
  record::SessionRow row;
  bool counted = false;
  int interruptions = 0;
  int pauses = 0;
  std::string subject;  ///< for example "sub-P01"
  std::string label;    ///< for example "ses-1"; empty if no participant has more than one session
  /// Days since the participant's first session; 0 if days are not recorded (simulated
  /// participants).
  std::chrono::days days{};
  /// The folder of the session's data, for example "sub-P01/ses-1".
  [[nodiscard]] std::string folder() const;
  /// The prefix of its file names, for example "sub-P01_ses-1".
  [[nodiscard]] std::string stem() const;
};

/// All sessions except erased sessions and sessions hidden at an interim look.
[[nodiscard]] std::vector<BidsSession> bids_sessions(const record::StudyStore& store);

/// Answers to one questionnaire as phenotype/<name>.tsv. A table has one session per participant,
/// because BIDS requires one row per participant.
struct BidsQuestionnaire {
  std::string tool;  ///< the questionnaire's name in letters, digits and underscores
  std::string name;  ///< the same, with the session's label if there is one
  DataTable table;   ///< participant_id, and one column per question
  /// The questions of the columns after the first; null: the wording is unknown.
  std::vector<const study::Question*> questions;
};

/// The questionnaires with at least one answer.
/// \param study  unblinded
/// \param free_text  left_out: without free-text answers and ages
[[nodiscard]] std::vector<BidsQuestionnaire> bids_questionnaires(
    const DatasetSource& study, const std::vector<BidsSession>& sessions, FreeText free_text);

/// participants.tsv: one row per participant, with the data of the participant's last session. Age
/// (in bands), sex and handedness come from sealed questionnaires after unblinding; columns without
/// values are left out. Of the personal data, only the last version of the consent form is
/// included. add_visit_and_group adds visits and groups. If sessions have labels, session data
/// except the group are only in *_sessions.tsv.
[[nodiscard]] DataTable bids_participants(const DatasetSource& source,
                                          const std::vector<BidsSession>& sessions,
                                          const Collection& collection,
                                          const std::vector<record::PersonalRecord>& consents);

/// sub-*_sessions.tsv of one subject.
[[nodiscard]] DataTable bids_sessions_of(const std::string& subject,
                                         const std::vector<BidsSession>& sessions,
                                         const Collection& collection);

}  // namespace touchtrial::analysis
