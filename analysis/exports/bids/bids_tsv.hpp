/// \file Tables in the form of BIDS: tab-separated, with "n/a" for a missing value. Source: BIDS
/// specification 1.10, "Tabular files".
#pragma once

#include "analysis/exports/data_table.hpp"

#include <string>

namespace touchtrial::analysis {

/// Tab-separated text in UTF-8 without a byte order mark, with line feeds and decimal points. An
/// empty text counts as missing; a tab or line end in a text becomes a space.
/// \throws std::invalid_argument if a row and the header differ in length
[[nodiscard]] std::string tsv_text(const DataTable& table);

}  // namespace touchtrial::analysis
