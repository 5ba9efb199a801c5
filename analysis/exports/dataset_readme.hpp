/// \file The README files of datasets. Private to exports.
#pragma once

#include "analysis/exports/dataset.hpp"

#include <string>

namespace touchtrial::analysis {

/// The README of a BIDS dataset, as plain text.
[[nodiscard]] std::string bids_readme(const DatasetSource& study, const DatasetOptions& options);

/// The README.md of a Psych-DS dataset.
[[nodiscard]] std::string psych_ds_readme(const DatasetSource& study);

}  // namespace touchtrial::analysis
