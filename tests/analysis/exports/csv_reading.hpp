/// \file Reads exported CSV files back, and makes from them the outcomes for the report.
#pragma once

#include "analysis/exports/csv_cells.hpp"
#include "analysis/outcomes/outcomes.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial {

/// Records and their fields, as the grammar of RFC 4180 says.
[[nodiscard]] std::vector<std::vector<std::string>> parse_csv(const std::string& text);

[[nodiscard]] std::string text_of_file(const std::filesystem::path& path);

/// Each row by the names of the header; fails the test if one is longer or shorter.
[[nodiscard]] std::vector<CsvRow> rows_of(const std::filesystem::path& path);

/// Checks cells of a row.
/// \param cells  "COLUMN=TEXT, COLUMN=TEXT"
void check_row(const CsvRow& row, const std::string& cells);

/// The outcomes that an export after unblinding was made from, as far as its CSV files contain
/// them.
[[nodiscard]] analysis::Outcomes outcomes_from_csv(const std::filesystem::path& folder);

}  // namespace touchtrial
