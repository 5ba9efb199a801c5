/// \file A study's data for others, as CSV files.
/// Format: docs/data-dictionary.md, "Exports".
#pragma once

#include "analysis/outcomes.hpp"

#include <filesystem>
#include <optional>
#include <vector>

namespace touchtrial::analysis {

/// Writes trials.csv, participants.csv, with outcomes one confusion_<method>.csv a presented
/// method, and last export.json, which says what the others are and whether they are simulated.
/// The folder is made if need be; other files in it stay. Equal studies give equal bytes.
/// \param outcomes  of this store; nothing before unblinding
/// \return the files, in the order written
/// \throws FileError if the folder or a file cannot be written
std::vector<std::filesystem::path> export_csv(const store::StudyStore& store,
                                              const std::optional<Outcomes>& outcomes,
                                              const std::filesystem::path& folder);

}  // namespace touchtrial::analysis
