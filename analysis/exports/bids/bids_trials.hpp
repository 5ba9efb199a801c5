/// \file The trials of a BIDS dataset. Private to exports.
#pragma once

#include "analysis/exports/data_table.hpp"
#include "analysis/exports/dataset.hpp"

#include <map>

namespace touchtrial::analysis {

/// The trials of each session in the order of presentation, unscored trials included. The columns
/// are those of trials.csv under the names of BIDS. A session without trials has an empty table.
struct BidsTrials {
  std::vector<std::string> columns;
  std::map<int, DataTable> by_session;
};

/// \param stimuli  whether the dataset includes the images, so that stim_file can name them
[[nodiscard]] BidsTrials bids_trials(const DatasetSource& study, bool stimuli);

}  // namespace touchtrial::analysis
