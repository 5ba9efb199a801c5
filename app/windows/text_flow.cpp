#include "app/windows/text_flow.hpp"

#include <cstddef>

#include <imgui.h>

namespace touchtrial::app {
namespace {

constexpr char32_t kUnknown = 0xFFFD;
constexpr char32_t kIdeographicSpace = 0x3000;
/// Letters that must not begin a line.
constexpr std::u32string_view kClosing =
    U")]}.,:;?!%\u00BB\u2019\u201D\u2026\u2025\u2030\u2103"
    U"、。，．・：；？！）」』】〉》〕｝％～〜ー々〻"
    U"ぁぃぅぇぉっゃゅょゎァィゥェォッャュョヮヵヶ";
/// Letters that must not end a line.
constexpr std::u32string_view kOpening = U"([{\u00AB\u2018\u201C（「『【〈《〔｛";

struct CodePoint {
  char32_t letter = kUnknown;
  std::size_t bytes = 1;
};

CodePoint code_point_at(std::string_view text, std::size_t offset) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  const unsigned first_byte = byte(offset);
  if (first_byte < 0x80U) return {first_byte, 1};
  const std::size_t continuation_bytes = first_byte >= 0xF0U ? 3 : (first_byte >= 0xE0U ? 2 : 1);
  if (first_byte < 0xC2U || first_byte > 0xF4U) return {};
  char32_t letter = first_byte & (0x3FU >> continuation_bytes);
  for (std::size_t i = 1; i <= continuation_bytes; ++i) {
    if ((byte(offset + i) & 0xC0U) != 0x80U) return {};
    letter = letter << 6U | (byte(offset + i) & 0x3FU);
  }
  return {letter, continuation_bytes + 1};
}

struct Letter {
  char32_t letter = 0;
  std::size_t begin = 0;  ///< bytes of the text
  std::size_t end = 0;
  bool bold = false;
  double width = 0.0;
};

std::vector<Letter> letters_of(std::string_view text, const ImFont& plain, const ImFont* bold,
                               double size) {
  std::vector<Letter> letters;
  letters.reserve(text.size());
  bool is_bold = false;
  for (std::size_t offset = 0; offset < text.size();) {
    if (bold != nullptr && text.substr(offset).starts_with("**")) {
      is_bold = !is_bold;
      offset += 2;
      continue;
    }
    const CodePoint point = code_point_at(text, offset);
    const ImFont& face = is_bold ? *bold : plain;
    const auto glyph = static_cast<ImWchar>(point.letter <= 0xFFFF ? point.letter : kUnknown);
    const double width = size * static_cast<double>(face.GetCharAdvance(glyph) / face.FontSize);
    letters.push_back({point.letter, offset, offset + point.bytes, is_bold, width});
    offset += point.bytes;
  }
  return letters;
}

bool may_break_between(char32_t left, char32_t right) {
  const bool is_left_blank = left == U' ' || left == kIdeographicSpace;
  const bool is_right_blank = right == U' ' || right == kIdeographicSpace;
  if (is_right_blank || kClosing.find(right) != kClosing.npos) return false;
  if (is_left_blank) return true;
  if (kOpening.find(left) != kOpening.npos) return false;
  return is_east_asian(left) || is_east_asian(right);
}

/// \return the first letter that is not on the line, or the line feed that ends it
std::size_t end_of_line(const std::vector<Letter>& letters, std::size_t line_begin, double width) {
  constexpr double kRounding = 1e-3;
  double x = 0.0;
  std::size_t best = line_begin;
  for (std::size_t i = line_begin; i < letters.size(); ++i) {
    const char32_t letter = letters[i].letter;
    if (letter == U'\n') return i;
    if (i > line_begin && may_break_between(letters[i - 1].letter, letter)) best = i;
    x += letters[i].width;
    if (x > width + kRounding && letter != U' ' && i > line_begin)
      return best > line_begin ? best : i;
  }
  return letters.size();
}

TextLine line_of(std::string_view text, const std::vector<Letter>& letters, std::size_t line_begin,
                 std::size_t end) {
  while (end > line_begin && letters[end - 1].letter == U' ') --end;
  TextLine line;
  for (std::size_t i = line_begin; i < end; ++i) {
    const Letter& letter = letters[i];
    const bool is_same_run =
        i > line_begin && letter.bold == letters[i - 1].bold && letter.begin == letters[i - 1].end;
    if (!is_same_run) line.runs.push_back({"", letter.bold, line.width});
    line.runs.back().text += text.substr(letter.begin, letter.end - letter.begin);
    line.width += letter.width;
  }
  return line;
}

}  // namespace

bool is_east_asian(char32_t letter) noexcept {
  return (letter >= 0x2E80 && letter <= 0x9FFF) || (letter >= 0xF900 && letter <= 0xFAFF) ||
         (letter >= 0xFF00 && letter <= 0xFFEF);
}

std::u32string code_points(std::string_view text) {
  std::u32string points;
  for (std::size_t offset = 0; offset < text.size();) {
    const CodePoint point = code_point_at(text, offset);
    points += point.letter;
    offset += point.bytes;
  }
  return points;
}

std::vector<TextLine> lines_of(std::string_view text, const ImFont& plain, const ImFont* bold,
                               double size, double width) {
  const std::vector<Letter> letters = letters_of(text, plain, bold, size);
  std::vector<TextLine> lines;
  for (std::size_t line_begin = 0; line_begin < letters.size();) {
    const std::size_t end = end_of_line(letters, line_begin, width);
    lines.push_back(line_of(text, letters, line_begin, end));
    line_begin = end < letters.size() && letters[end].letter == U'\n' ? end + 1 : end;
  }
  return lines;
}

}  // namespace touchtrial::app
