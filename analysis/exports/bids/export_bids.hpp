/// \file Exports a study as a BIDS dataset of behaviour. Source: BIDS specification 1.11,
/// "Behavioral experiments (with no neural recordings)" and "Motion". Layout: docs/exports.md.
#pragma once

#include "analysis/exports/dataset.hpp"

#include <filesystem>
#include <vector>

namespace touchtrial::analysis {

/// Before unblinding, trials contain no more data than in the CSV export.
/// \return the files, in the order written
/// \throws UsageError if traces or stimuli are requested before unblinding
/// \throws FileError if the folder or a file cannot be written, the folder contains other files, or
///   an image of the study is missing
std::vector<std::filesystem::path> export_bids(const DatasetSource& study,
                                               const DatasetOptions& options,
                                               const std::filesystem::path& folder);

}  // namespace touchtrial::analysis
