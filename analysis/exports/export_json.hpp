/// \file A study's data for others, as one JSON file.
/// Format: docs/data-dictionary.md, "Exports".
#pragma once

#include "analysis/outcomes.hpp"

#include <filesystem>
#include <optional>

namespace touchtrial::analysis {

/// Writes study.json: the report (before unblinding the quality report), participants and trials
/// with the columns of the CSV files as keys; a missing value is null, times are in seconds.
/// Arguments and errors as export_csv.
/// \return the file
std::filesystem::path export_json(const store::StudyStore& store,
                                  const std::optional<Outcomes>& outcomes,
                                  const std::filesystem::path& folder);

}  // namespace touchtrial::analysis
