/// \file Tables for a terminal, with padded columns, split into several parts if they are too wide.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::analysis {

/// Maximum width of the program's tables and paragraphs, columns.
inline constexpr std::size_t kTextWidth = 100;
/// Maximum width of a table's cell, columns.
inline constexpr std::size_t kCellWidth = 24;

/// The columns of a UTF-8 text on a terminal. East Asian wide characters take two.
[[nodiscard]] std::size_t display_width(std::string_view text);

/// The text, cut between characters to at most `width` columns, with an ellipsis if cut.
[[nodiscard]] std::string fitted(std::string_view text, std::size_t width);

/// A paragraph broken at spaces into lines of at most `width` columns; a longer word gets its
/// own line.
/// \return at least one line
[[nodiscard]] std::vector<std::string> lines_of(std::string_view paragraph, std::size_t width);

/// A paragraph broken at spaces to `width` columns, ending with a line feed.
/// \param first  text before the first line; the other lines are indented by its width
[[nodiscard]] std::string wrapped(std::string_view first, std::string_view paragraph,
                                  std::size_t width = kTextWidth);

/// Rows of text under a header. Cells are cut to kCellWidth columns.
class TextTable {
 public:
  /// \param left  the left-aligned columns; the others are right-aligned
  explicit TextTable(std::vector<std::string> header, std::set<std::size_t> left = {0});

  /// \throws std::invalid_argument if the number of cells differs from the header's
  void add(std::vector<std::string> cells);

  /// All rows, indented by two columns, each ending with a line feed. Columns that do not fit
  /// follow below, with the first column repeated. Empty lines are omitted.
  [[nodiscard]] std::string text(std::size_t width = kTextWidth) const;

 private:
  [[nodiscard]] std::vector<std::size_t> column_widths() const;

  std::vector<std::vector<std::string>> rows_;  ///< the header first
  std::set<std::size_t> left_;
};

}  // namespace touchtrial::analysis
