/// \file Exports a study as a Psych-DS dataset. Source: Psych-DS schema 1.5.1. Layout:
/// docs/exports.md.
#pragma once

#include "analysis/exports/dataset.hpp"

#include <filesystem>
#include <vector>

namespace touchtrial::analysis {

/// Uses only `authors`, `license`, `free_text` and `consents` of the options. Before unblinding,
/// trials contain no more data than in the CSV export.
/// \return the files, in the order written
/// \throws FileError if the folder or a file cannot be written, or the folder contains other files
std::vector<std::filesystem::path> export_psych_ds(const DatasetSource& study,
                                                   const DatasetOptions& options,
                                                   const std::filesystem::path& folder);

}  // namespace touchtrial::analysis
