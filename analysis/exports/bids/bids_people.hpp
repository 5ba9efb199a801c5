/// \file The sessions and participants in a BIDS dataset, and the names of their files. Private to
/// exports.
#pragma once

#include "analysis/exports/data_table.hpp"
#include "analysis/exports/dataset.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

/// A session in the dataset.
struct BidsSession {
  store::SessionRow row;
  bool counted = false;
  std::string subject;  ///< for example "sub-P01"
  std::string label;    ///< for example "ses-1"; empty if nobody has more than one session
  /// The folder of its files, for example "sub-P01/ses-1/beh".
  [[nodiscard]] std::string folder() const;
  /// The beginning of their names, for example "sub-P01_ses-1".
  [[nodiscard]] std::string stem() const;
};

/// All sessions except those of participants who withdrew and those that an interim look does not
/// show.
[[nodiscard]] std::vector<BidsSession> bids_sessions(const store::StudyStore& store);

/// participants.tsv: one row for each participant, with the data of the participant's last session.
/// Age (in bands), sex and handedness come from sealed questionnaires after unblinding; a column is
/// missing if nobody has a value. The file of personal data is never read.
[[nodiscard]] DataTable bids_participants(const DatasetSource& source,
                                          const std::vector<BidsSession>& sessions);

/// sub-*_sessions.tsv of one subject.
[[nodiscard]] DataTable bids_sessions_of(const std::string& subject,
                                         const std::vector<BidsSession>& sessions);

}  // namespace touchtrial::analysis
