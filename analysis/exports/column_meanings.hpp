/// \file The meaning of each exported column, for the sidecars and dictionaries of datasets.
/// docs/data-dictionary.md, "Exports", gives the same meanings.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::analysis {

struct ColumnMeaning {
  std::string description;
  std::string unit{};                                         ///< a BIDS unit; empty: none
  std::vector<std::pair<std::string, std::string>> levels{};  ///< values and what they mean
};

/// \param column  its name in the CSV files or in BIDS
/// \throws std::out_of_range if no export has such a column
[[nodiscard]] const ColumnMeaning& meaning_of(const std::string& column);

}  // namespace touchtrial::analysis
