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
  std::string label;    ///< for example "ses-1"; empty if nobody has more than one session
  /// Between the participant's first session and this one; 0 if days are not recorded, as of
  /// simulated participants.
  std::chrono::days days{};
  /// The folder of its datatypes, for example "sub-P01/ses-1".
  [[nodiscard]] std::string folder() const;
  /// The beginning of their names, for example "sub-P01_ses-1".
  [[nodiscard]] std::string stem() const;
};

/// All sessions except those of participants who withdrew and those that an interim look does not
/// show.
[[nodiscard]] std::vector<BidsSession> bids_sessions(const record::StudyStore& store);

/// Participants' answers to one questionnaire in one session each, as phenotype/<name>.tsv, in
/// which BIDS wants one row a participant.
struct BidsQuestionnaire {
  std::string tool;  ///< the questionnaire, of letters, digits and underscores
  std::string name;  ///< the same, and if there are sessions, which
  DataTable table;   ///< participant_id, and one column a question
  /// The questions of the columns after these; null: nobody knows the wording.
  std::vector<const study::Question*> questions;
};

/// The questionnaires that somebody answered.
/// \param study  unblinded
/// \param typed  left_out: without answers in words, and without ages
[[nodiscard]] std::vector<BidsQuestionnaire> bids_questionnaires(
    const DatasetSource& study, const std::vector<BidsSession>& sessions, Typed typed);

/// participants.tsv: one row for each participant, with the data of the participant's last session.
/// Age (in bands), sex and handedness come from sealed questionnaires after unblinding; a column is
/// missing if nobody has a value. Of the personal data it has the last version of the consent form.
/// In studies with visits or groups it has those of the collection (add_visit_and_group). If there
/// are labelled sessions, what belongs to a session (not the group) is in *_sessions.tsv alone.
[[nodiscard]] DataTable bids_participants(const DatasetSource& source,
                                          const std::vector<BidsSession>& sessions,
                                          const Collection& collection,
                                          const std::vector<record::PersonalRecord>& consents);

/// sub-*_sessions.tsv of one subject.
[[nodiscard]] DataTable bids_sessions_of(const std::string& subject,
                                         const std::vector<BidsSession>& sessions,
                                         const Collection& collection);

}  // namespace touchtrial::analysis
