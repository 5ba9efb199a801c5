/// \file Tables for a terminal: padded columns, folded into several parts where they are too wide.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::analysis {

/// How wide the program's tables and paragraphs get, in columns.
inline constexpr std::size_t kTextWidth = 100;

/// Columns that a UTF-8 text takes on a terminal; East Asian wide characters take two.
[[nodiscard]] std::size_t display_width(std::string_view text);

/// The text, cut at a character to at most `width` columns; what was cut shows as an ellipsis.
[[nodiscard]] std::string fitted(std::string_view text, std::size_t width);

/// A paragraph broken at spaces to kTextWidth columns. \param first  before its first line; the
///   others are indented as far. Ends with a line feed.
[[nodiscard]] std::string wrapped(std::string_view first, std::string_view paragraph);

/// Rows of text under a header. The first column is aligned to the left, the others to the right.
class TextTable {
 public:
  explicit TextTable(std::vector<std::string> header);

  /// \throws std::invalid_argument if the number of cells is not the header's
  void add(std::vector<std::string> cells);

  /// All rows, indented by two columns, each ending with a line feed. Columns that do not fit
  /// follow below, with the first column repeated.
  [[nodiscard]] std::string text(std::size_t width = kTextWidth) const;

 private:
  [[nodiscard]] std::vector<std::size_t> column_widths() const;

  std::vector<std::vector<std::string>> rows_;  ///< the header first
};

}  // namespace touchtrial::analysis
