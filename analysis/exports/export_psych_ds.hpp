/// \file A study as a Psych-DS dataset. Source: Psych-DS schema 1.5.1; what stands where:
/// docs/exports.md.
#pragma once

#include "analysis/exports/dataset.hpp"

#include <filesystem>
#include <vector>

namespace touchtrial::analysis {

/// Of `options` authors and license alone count. Before unblinding the trials say no more than the
/// CSV export does then.
/// \return the files, in the order written
/// \throws FileError if the folder or a file cannot be written or holds something else's files
std::vector<std::filesystem::path> export_psych_ds(const DatasetSource& study,
                                                   const DatasetOptions& options,
                                                   const std::filesystem::path& folder);

}  // namespace touchtrial::analysis
