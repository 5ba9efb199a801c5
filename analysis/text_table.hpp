/// \file Tables for a terminal, with padded columns, split into several parts if they are too wide.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::analysis {

/// Maximum width of the program's tables and paragraphs, columns.
inline constexpr std::size_t kTextWidth = 100;

/// The number of columns of a UTF-8 text on a terminal. East Asian wide characters take two.
[[nodiscard]] std::size_t display_width(std::string_view text);

/// The text, cut between characters to at most `width` columns. An ellipsis marks a cut.
[[nodiscard]] std::string fitted(std::string_view text, std::size_t width);

/// A paragraph broken at spaces to kTextWidth columns, ending with a line feed.
/// \param first  text before the first line; the other lines are indented by its width
[[nodiscard]] std::string wrapped(std::string_view first, std::string_view paragraph);

/// Rows of text under a header. The first column is left-aligned, the others are right-aligned.
class TextTable {
 public:
  explicit TextTable(std::vector<std::string> header);

  /// Adds a row.
  /// \throws std::invalid_argument if the number of cells differs from the header's
  void add(std::vector<std::string> cells);

  /// All rows, indented by two columns, each ending with a line feed. Columns that do not fit
  /// follow below, with the first column repeated.
  [[nodiscard]] std::string text(std::size_t width = kTextWidth) const;

 private:
  [[nodiscard]] std::vector<std::size_t> column_widths() const;

  std::vector<std::vector<std::string>> rows_;  ///< the header first
};

}  // namespace touchtrial::analysis
