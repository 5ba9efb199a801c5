/// \file Exports a study's data as CSV files. Format: docs/data-dictionary.md, "Exports".
#pragma once

#include "analysis/outcomes.hpp"

#include <filesystem>
#include <optional>
#include <vector>

namespace touchtrial::analysis {

/// Writes trials.csv, participants.csv, deviations.csv, servo.csv and study.csv. With outcomes it
/// also writes the tables of the protocol's analysis (for example, confusion_<method>.csv for each
/// presented method), unscored_trials.csv and study_file.json. The last file is export.json, which
/// lists the others and says whether they are simulated. Creates the folder if necessary; files
/// that no export wrote stay. Equal studies give equal bytes.
/// \param outcomes  of this store; nothing before unblinding
/// \return the files, in the order written
/// \throws FileError if the folder or a file cannot be written
std::vector<std::filesystem::path> export_csv(const store::StudyStore& store,
                                              const std::optional<Outcomes>& outcomes,
                                              const std::filesystem::path& folder);

}  // namespace touchtrial::analysis
