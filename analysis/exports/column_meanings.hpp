/// \file What each exported column means, for the sidecars and dictionaries of datasets.
/// The same as in docs/data-dictionary.md, "Exports".
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

/// \param column  as in the CSV files, or by BIDS's name for it
/// \throws std::out_of_range if no export has such a column
[[nodiscard]] const ColumnMeaning& meaning_of(const std::string& column);

}  // namespace touchtrial::analysis
