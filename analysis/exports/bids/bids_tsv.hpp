/// \file Tables as BIDS wants them: tab-separated, "n/a" for what is missing.
/// Source: BIDS specification 1.10, "Tabular files".
#pragma once

#include "analysis/exports/data_table.hpp"

#include <string>

namespace touchtrial::analysis {

/// UTF-8 without a byte order mark, line feeds, decimal dots; an empty text is missing too, and a
/// tab or line end in a text becomes a space.
/// \throws std::invalid_argument if a row's length is not the header's
[[nodiscard]] std::string tsv_text(const DataTable& table);

}  // namespace touchtrial::analysis
