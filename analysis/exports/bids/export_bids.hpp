/// \file A study as a BIDS dataset of behaviour.
/// Source: BIDS specification 1.10, "Behavioral experiments (with no neural recordings)".
/// What stands where: docs/exports.md.
#pragma once

#include "analysis/exports/dataset.hpp"

#include <filesystem>
#include <vector>

namespace touchtrial::analysis {

/// Before unblinding the trials say no more than the CSV export does then.
/// \return the files, in the order written
/// \throws UsageError if traces or stimuli are asked for before unblinding
/// \throws FileError if the folder or a file cannot be written, holds something else's files, or
/// one
///   of the study's images is missing
std::vector<std::filesystem::path> export_bids(const DatasetSource& study,
                                               const DatasetOptions& options,
                                               const std::filesystem::path& folder);

}  // namespace touchtrial::analysis
