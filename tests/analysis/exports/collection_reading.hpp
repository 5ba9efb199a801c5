/// \file The facts about a study's collection, read back from its exported CSV files.
#pragma once

#include "analysis/exports/csv_cells.hpp"
#include "analysis/outcomes/collection.hpp"

#include <filesystem>

namespace touchtrial {

/// A row of participants.csv.
[[nodiscard]] record::SessionRow session_row_of(const CsvRow& row);

/// \param state  decides the flow of participants
[[nodiscard]] analysis::Collection collection_from_csv(const std::filesystem::path& folder,
                                                       const record::StudyState& state);

}  // namespace touchtrial
