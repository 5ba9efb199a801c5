#include "analysis/report/escaping.hpp"

#include "core/errors.hpp"

#include <cstdint>
#include <map>
#include <string_view>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

/// Characters with their own LaTeX command.
const std::map<std::uint32_t, const char*>& named_signs() {
  static const std::map<std::uint32_t, const char*> kSigns{
      {'\\', "\\textbackslash{}"},
      {'{', "\\{"},
      {'}', "\\}"},
      {'$', "\\$"},
      {'&', "\\&"},
      {'#', "\\#"},
      {'_', "\\_"},
      {'%', "\\%"},
      {'~', "\\textasciitilde{}"},
      {'^', "\\textasciicircum{}"},
      {'<', "\\textless{}"},
      {'>', "\\textgreater{}"},
      {'|', "\\textbar{}"},
      {'"', "\\textquotedbl{}"},
      {'\'', "\\textquotesingle{}"},
      {'`', "\\textasciigrave{}"},
      {'-', "-{}"},
      {'[', "{[}"},
      {']', "{]}"},
      {0xa0, "~"},
      {0xb1, "$\\pm$"},
      {0xb2, "$^2$"},
      {0xb5, "$\\mu$"},
      {0xb7, "$\\cdot$"},
      {0xd7, "$\\times$"},
      {0x3b1, "$\\alpha$"},
      {0x3b7, "$\\eta$"},
      {0x3bc, "$\\mu$"},
      {0x3c7, "$\\chi$"},
      {0x2013, "--"},
      {0x2014, "---"},
      {0x2018, "`"},
      {0x2019, "'"},
      {0x201c, "``"},
      {0x201d, "''"},
      {0x2026, "\\ldots{}"},
      {0x2032, "$'$"},
      {0x2190, "$\\leftarrow$"},
      {0x2192, "$\\rightarrow$"},
      {0x2212, "$-$"},
      {0x2264, "$\\leq$"},
      {0x2265, "$\\geq$"},
  };
  return kSigns;
}

constexpr std::uint32_t kNoCharacter = 0xfffd;

std::uint32_t decoded_character(const std::string& text, std::size_t position, std::size_t bytes,
                                std::uint32_t lead) {
  std::uint32_t code = lead;
  for (std::size_t i = 1; i < bytes; ++i) {
    if (position + i >= text.size()) return kNoCharacter;
    const auto next = static_cast<unsigned char>(text[position + i]);
    if ((next & 0xc0U) != 0x80U) return kNoCharacter;
    code = (code << 6U) | (next & 0x3fU);
  }
  return code;
}

/// Reads the character at `position` and moves `position` past it. A byte that is not valid
/// UTF-8 counts as one kNoCharacter.
std::uint32_t next_character(const std::string& text, std::size_t& position) {
  const auto first = static_cast<unsigned char>(text[position]);
  std::size_t bytes = 1;
  std::uint32_t code = first < 0x80U ? first : kNoCharacter;
  if ((first & 0xe0U) == 0xc0U) {
    bytes = 2;
    code = decoded_character(text, position, bytes, first & 0x1fU);
  } else if ((first & 0xf0U) == 0xe0U) {
    bytes = 3;
    code = decoded_character(text, position, bytes, first & 0x0fU);
  } else if ((first & 0xf8U) == 0xf0U) {
    bytes = 4;
    code = decoded_character(text, position, bytes, first & 0x07U);
  }
  position += code == kNoCharacter ? 1 : bytes;
  return code;
}

/// Accented Latin letters of T1 fonts: Latin-1, and the most common of Latin Extended-A.
bool is_t1_letter(std::uint32_t code) {
  return (code >= 0xc0 && code <= 0xff && code != 0xd7 && code != 0xf7) ||
         (code >= 0x102 && code <= 0x107) || (code >= 0x10c && code <= 0x111) ||
         (code >= 0x118 && code <= 0x11b) || code == 0x11e || code == 0x11f || code == 0x130 ||
         (code >= 0x141 && code <= 0x144) || code == 0x147 || code == 0x148 ||
         (code >= 0x150 && code <= 0x155) || (code >= 0x158 && code <= 0x15b) ||
         (code >= 0x15e && code <= 0x165) || (code >= 0x16e && code <= 0x171) ||
         (code >= 0x178 && code <= 0x17e);
}

}  // namespace

std::string xml_escaped(const std::string& text) {
  static const std::map<char, const char*> kEntities{
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}};
  std::string escaped;
  for (const char c : one_line(text)) {
    const auto entity = kEntities.find(c);
    escaped += entity == kEntities.end() ? std::string(1, c) : entity->second;
  }
  return escaped;
}

std::string markdown_escaped(const std::string& text) {
  constexpr std::string_view kMarkup = "\\`*_{}[]<>#|~&!$^";
  std::string escaped;
  for (const char c : one_line(text)) {
    if (kMarkup.find(c) != std::string_view::npos) escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string latex_escaped(const std::string& text) {
  std::string escaped;
  for (std::size_t position = 0; position < text.size();) {
    const std::size_t begin = position;
    const std::uint32_t code = next_character(text, position);
    const auto sign = named_signs().find(code);
    if (sign != named_signs().end()) {
      escaped += sign->second;
    } else if (code < 0x20 || code == 0x7f) {
      escaped += ' ';
    } else if (code < 0x80 || is_t1_letter(code)) {
      escaped += text.substr(begin, position - begin);
    } else {
      escaped += fmt::format("{{[}}U+{:04X}{{]}}", code);
    }
  }
  return escaped;
}

}  // namespace touchtrial::analysis
