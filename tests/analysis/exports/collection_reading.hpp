/// \file How a study was collected, read back from its exported CSV files.
#pragma once

#include "analysis/collection.hpp"
#include "analysis/exports/csv_cells.hpp"

#include <filesystem>

namespace touchtrial {

/// A row of participants.csv.
[[nodiscard]] store::SessionRow session_row_of(const CsvRow& row);

/// \param state  which the flow of participants depends on
[[nodiscard]] analysis::Collection collection_from_csv(const std::filesystem::path& folder,
                                                       const store::StudyState& state);

}  // namespace touchtrial
