/// \file Exports a study's data as one JSON file. Format: docs/data-dictionary.md, "Exports".
#pragma once

#include "analysis/outcomes.hpp"

#include <filesystem>
#include <optional>

namespace touchtrial::analysis {

/// Writes study.json: the report (before unblinding, the quality report) and the tables of the CSV
/// export, with their columns as keys. A missing value is null; times are in seconds. Arguments and
/// errors are those of export_csv.
/// \return the file
std::filesystem::path export_json(const store::StudyStore& store,
                                  const std::optional<Outcomes>& outcomes,
                                  const std::filesystem::path& folder);

}  // namespace touchtrial::analysis
