/// \file Line breaking for Latin and East Asian scripts, with bold words.
#pragma once

#include <string>
#include <string_view>
#include <vector>

struct ImFont;

namespace touchtrial::app {

/// Letters of one weight, side by side.
struct TextRun {
  std::string text;
  bool bold = false;
  double x = 0.0;  ///< distance from the line's beginning, window units
};

struct TextLine {
  std::vector<TextRun> runs;
  double width = 0.0;  ///< window units, without blanks at the end
};

/// Breaks a text at line feeds, at blanks, and beside Chinese and Japanese letters, but neither
/// before closing punctuation nor after opening punctuation (after JIS X 4051). A word that is
/// wider than a line may break at any letter.
/// \param text  UTF-8
/// \param bold  face of the words between "**"; null: "**" is text
/// \param size  size of the letters, window units
/// \param width  width of the lines, window units
[[nodiscard]] std::vector<TextLine> lines_of(std::string_view text, const ImFont& plain,
                                             const ImFont* bold, double size, double width);

/// The code points of UTF-8. A byte that is not UTF-8 counts as U+FFFD.
[[nodiscard]] std::u32string code_points(std::string_view text);

/// Whether lines may break beside this letter: ideographs, kana, and their punctuation.
[[nodiscard]] bool is_east_asian(char32_t letter) noexcept;

}  // namespace touchtrial::app
