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

/// One value: nothing, a text, a whole number, a number, or a time (written in seconds).
using DataCell =
    std::variant<std::monostate, std::string, std::int64_t, double, std::chrono::nanoseconds>;

/// 1 or 0.
[[nodiscard]] DataCell flag(bool value);

/// The value, or a missing one.
template <typename Value>
[[nodiscard]] DataCell or_nothing(const std::optional<Value>& value) {
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

/// The exact time in seconds, with a decimal point and as many decimals as the nanoseconds need.
[[nodiscard]] std::string seconds_text(std::chrono::nanoseconds time);

/// Free text made safe for a cell that a spreadsheet may open. Source: OWASP, "CSV Injection".
/// \return `text` as core/printable.hpp shows it. It is preceded by an apostrophe if it is not a
///   number and begins with =, +, -, @, a tab or a carriage return, which would make it a formula
[[nodiscard]] std::string harmless_cell(const std::string& text);

/// The text as a quoted string of R.
[[nodiscard]] std::string r_text(const std::string& text);

/// CSV as in RFC 4180, except that each line ends with a single line feed. The text is UTF-8
/// without a byte order mark and begins with a header. Texts are harmless cells. A text that
/// contains a comma, a quote or a line end is quoted. Numbers have a decimal point and the fewest
/// digits that read back the same. A missing value is an empty field.
/// \throws std::invalid_argument if a row and the header differ in length
[[nodiscard]] std::string csv_text(const DataTable& table);

/// The table in the form of BIDS: tab-separated UTF-8 without a byte order mark, with line feeds
/// and decimal points; "n/a" for a missing value. An empty text counts as missing; a tab or line
/// end in a text becomes a space. Source: BIDS specification 1.11, "Tabular files".
/// \throws std::invalid_argument if a row and the header differ in length
[[nodiscard]] std::string tsv_text(const DataTable& table);

}  // namespace touchtrial::analysis
