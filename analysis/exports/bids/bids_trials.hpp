/// \file The trials of a BIDS dataset. Private to exports.
#pragma once

#include "analysis/exports/data_table.hpp"
#include "analysis/exports/dataset.hpp"

#include <map>

namespace touchtrial::analysis {

/// The columns of trials.csv by BIDS's names, and of every session its trials in the order of
/// presentation, unscored ones too; sessions without a trial are there with none.
struct BidsTrials {
  std::vector<std::string> columns;
  std::map<int, DataTable> by_session;
};

/// \param stimuli  whether the images are in the dataset, so that stim_file can name them
[[nodiscard]] BidsTrials bids_trials(const DatasetSource& study, bool stimuli);

}  // namespace touchtrial::analysis
