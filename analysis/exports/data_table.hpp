/// \file A table of named columns for exports, and its text as CSV and as TSV.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

namespace touchtrial::analysis {

/// One value: missing, a text, a whole number, a number, or a time (written in seconds).
using DataCell =
    std::variant<std::monostate, std::string, std::int64_t, double, std::chrono::nanoseconds>;

/// 1 or 0.
[[nodiscard]] DataCell flag(bool value);

/// The value, or a missing one.
template <typename Value>
[[nodiscard]] DataCell optional_cell(const std::optional<Value>& value) {
  if (!value) return std::monostate{};
  if constexpr (std::is_integral_v<Value>) {
    return std::int64_t{*value};
  } else {
    return *value;
  }
}

/// A time in UTC as ISO 8601; empty for simulated participants, whose wall clock is meaningless.
[[nodiscard]] DataCell utc_cell(std::chrono::nanoseconds at, bool simulated);

struct DataTable {
  std::vector<std::string> columns;
  std::vector<std::vector<DataCell>> rows;  ///< each as long as `columns`
};

/// The exact time in seconds, with a decimal point and no trailing zeros.
[[nodiscard]] std::string seconds_text(std::chrono::nanoseconds time);

/// Free text made safe for a cell that a spreadsheet may open. Source: OWASP, "CSV Injection".
/// \return the printable text (core/printable.hpp), preceded by an apostrophe if it would be a
///   formula: it is not a number and begins with =, +, -, @, a tab or a carriage return
[[nodiscard]] std::string harmless_cell(const std::string& text);

/// The text as a quoted R string.
[[nodiscard]] std::string r_text(const std::string& text);

/// CSV as in RFC 4180, except that each line ends with a single line feed. The text is UTF-8
/// without a byte order mark and begins with a header. Texts are harmless cells. A text that
/// contains a comma, a quote or a line end is quoted. Numbers have a decimal point and the fewest
/// digits that parse to the same value. A missing value is an empty field.
/// \throws std::invalid_argument if a row and the header differ in length
[[nodiscard]] std::string csv_text(const DataTable& table);

/// TSV as BIDS requires: tab-separated UTF-8 without a byte order mark, with line feeds and decimal
/// points. Missing values and empty texts are "n/a"; tabs and line ends in a text become spaces.
/// Source: BIDS specification 1.11, "Tabular files".
/// \throws std::invalid_argument if a row and the header differ in length
[[nodiscard]] std::string tsv_text(const DataTable& table);

}  // namespace touchtrial::analysis
