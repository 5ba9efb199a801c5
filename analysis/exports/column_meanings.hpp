/// \file The columns of exported tables and their meanings. The sidecars of BIDS and Psych-DS and
/// the tables of docs/data-dictionary.md, "Exports", follow from them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace touchtrial::analysis {

/// The meaning of an exported column.
struct ColumnMeaning {
  std::string description;
  std::string unit{};                                         ///< a BIDS unit; empty: none
  std::vector<std::pair<std::string, std::string>> levels{};  ///< values and their meanings
};

/// The prefix of rating columns, followed by the scale's id.
inline constexpr std::string_view kRatingColumn = "rating_";

/// \param column  its name in CSV files or in BIDS
/// \param file  a file whose column has a special meaning; empty: the meaning in most files
/// \return the meaning; for an unknown column, that it belongs to the protocol's analysis
[[nodiscard]] ColumnMeaning meaning_of(const std::string& column, std::string_view file = {});

/// The columns of a CSV file, in their order.
/// \param file  "answers.csv"; not trials.csv and participants.csv, whose columns have values
///   (trial_columns, participant_columns)
/// \throws std::out_of_range if it is unknown
[[nodiscard]] const std::vector<std::string>& columns_of(std::string_view file);

}  // namespace touchtrial::analysis
