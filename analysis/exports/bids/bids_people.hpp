/// \file Who is in a BIDS dataset, and what their files are called. Private to exports.
#pragma once

#include "analysis/exports/data_table.hpp"
#include "analysis/exports/dataset.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

/// One session that is in the dataset.
struct BidsSession {
  store::SessionRow row;
  bool counted = false;
  std::string subject;  ///< "sub-P01"
  std::string label;    ///< "ses-1"; empty if nobody has more than one session
  /// "sub-P01/ses-1/beh", where its files are.
  [[nodiscard]] std::string folder() const;
  /// "sub-P01_ses-1", what their names begin with.
  [[nodiscard]] std::string stem() const;
};

/// All sessions but those of participants who withdrew, or that an interim look does not show.
[[nodiscard]] std::vector<BidsSession> bids_sessions(const store::StudyStore& store);

/// participants.tsv: one row a participant, of the session that stands. Age (in bands), sex and
/// handedness come from what participants answered in sealed questionnaires, after unblinding, and
/// are no columns where nobody answered; the file of personal data is never read.
[[nodiscard]] DataTable bids_participants(const DatasetSource& source,
                                          const std::vector<BidsSession>& sessions);

/// sub-*_sessions.tsv of one subject.
[[nodiscard]] DataTable bids_sessions_of(const std::string& subject,
                                         const std::vector<BidsSession>& sessions);

}  // namespace touchtrial::analysis
