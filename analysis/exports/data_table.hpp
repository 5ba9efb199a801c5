/// \file Rows of named columns on their way into a file for others.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace touchtrial::analysis {

/// One value: nothing, a text, a whole number, a number, or a time (written in seconds).
using DataCell =
    std::variant<std::monostate, std::string, std::int64_t, double, std::chrono::nanoseconds>;

struct DataTable {
  std::vector<std::string> columns;
  std::vector<std::vector<DataCell>> rows;  ///< each as long as `columns`
};

/// Seconds with as many decimals as the nanoseconds need: exact, with a decimal dot.
[[nodiscard]] std::string seconds_text(std::chrono::nanoseconds time);

/// RFC 4180 but for its line ends, which are single line feeds: UTF-8 without a byte order mark, a
/// header, a text quoted where it holds a comma, a quote or a line end, numbers with a decimal dot
/// and the fewest digits that read back the same, nothing for a missing value.
/// \throws std::invalid_argument if a row's length is not the header's
[[nodiscard]] std::string csv_text(const DataTable& table);

}  // namespace touchtrial::analysis
