#include "app/windows/text_flow.hpp"

#include <cstddef>

#include <imgui.h>

namespace touchtrial::app {
namespace {

constexpr char32_t kUnknown = 0xFFFD;
constexpr char32_t kIdeographicSpace = 0x3000;
/// Never at a line's beginning.
constexpr std::u32string_view kClosing =
    U")]}.,:;?!%\u00BB\u2019\u201D\u2026\u2025\u2030\u2103"
    U"、。，．・：；？！）」』】〉》〕｝％～〜ー々〻"
    U"ぁぃぅぇぉっゃゅょゎァィゥェォッャュョヮヵヶ";
/// Never at a line's end.
constexpr std::u32string_view kOpening = U"([{\u00AB\u2018\u201C（「『【〈《〔｛";

struct CodePoint {
  char32_t letter = kUnknown;
  std::size_t bytes = 1;
};

CodePoint code_point_at(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  const unsigned first = byte(at);
  if (first < 0x80U) return {first, 1};
  const std::size_t more = first >= 0xF0U ? 3 : (first >= 0xE0U ? 2 : 1);
  if (first < 0xC2U || first > 0xF4U) return {};
  char32_t letter = first & (0x3FU >> more);
  for (std::size_t i = 1; i <= more; ++i) {
    if ((byte(at + i) & 0xC0U) != 0x80U) return {};
    letter = letter << 6U | (byte(at + i) & 0x3FU);
  }
  return {letter, more + 1};
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
  for (std::size_t at = 0; at < text.size();) {
    if (bold != nullptr && text.substr(at).starts_with("**")) {
      is_bold = !is_bold;
      at += 2;
      continue;
    }
    const CodePoint point = code_point_at(text, at);
    const ImFont& face = is_bold ? *bold : plain;
    const auto shown = static_cast<ImWchar>(point.letter <= 0xFFFF ? point.letter : kUnknown);
    const double width = size * static_cast<double>(face.GetCharAdvance(shown) / face.FontSize);
    letters.push_back({point.letter, at, at + point.bytes, is_bold, width});
    at += point.bytes;
  }
  return letters;
}

bool may_break_between(char32_t before, char32_t after) {
  const bool blank_before = before == U' ' || before == kIdeographicSpace;
  const bool blank_after = after == U' ' || after == kIdeographicSpace;
  if (blank_after || kClosing.find(after) != kClosing.npos) return false;
  if (blank_before) return true;
  if (kOpening.find(before) != kOpening.npos) return false;
  return is_east_asian(before) || is_east_asian(after);
}

/// \return the first letter that is not on the line, or the line feed that ends it
std::size_t end_of_line(const std::vector<Letter>& letters, std::size_t from, double width) {
  constexpr double kRounding = 1e-3;
  double x = 0.0;
  std::size_t best = from;
  for (std::size_t i = from; i < letters.size(); ++i) {
    const char32_t letter = letters[i].letter;
    if (letter == U'\n') return i;
    if (i > from && may_break_between(letters[i - 1].letter, letter)) best = i;
    x += letters[i].width;
    if (x > width + kRounding && letter != U' ' && i > from) return best > from ? best : i;
  }
  return letters.size();
}

TextLine line_of(std::string_view text, const std::vector<Letter>& letters, std::size_t from,
                 std::size_t end) {
  while (end > from && letters[end - 1].letter == U' ') --end;
  TextLine line;
  for (std::size_t i = from; i < end; ++i) {
    const Letter& letter = letters[i];
    const bool joins =
        i > from && letter.bold == letters[i - 1].bold && letter.begin == letters[i - 1].end;
    if (!joins) line.runs.push_back({"", letter.bold, line.width});
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
  for (std::size_t at = 0; at < text.size();) {
    const CodePoint point = code_point_at(text, at);
    points += point.letter;
    at += point.bytes;
  }
  return points;
}

std::vector<TextLine> lines_of(std::string_view text, const ImFont& plain, const ImFont* bold,
                               double size, double width) {
  const std::vector<Letter> letters = letters_of(text, plain, bold, size);
  std::vector<TextLine> lines;
  for (std::size_t from = 0; from < letters.size();) {
    const std::size_t end = end_of_line(letters, from, width);
    lines.push_back(line_of(text, letters, from, end));
    from = end < letters.size() && letters[end].letter == U'\n' ? end + 1 : end;
  }
  return lines;
}

}  // namespace touchtrial::app
