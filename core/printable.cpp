#include "core/printable.hpp"

#include <array>
#include <cstddef>
#include <string_view>

namespace touchtrial {
namespace {

unsigned byte_at(std::string_view text, std::size_t index) {
  return static_cast<unsigned char>(text[index]);
}

/// A range of lead bytes, and the range of second bytes that may follow them. All other pairs are
/// overlong, surrogates, or beyond Unicode (Unicode 15, table 3-7).
struct LeadBytes {
  unsigned first, last;
  unsigned second_first, second_last;
  std::size_t length;
};

constexpr std::array<LeadBytes, 9> kLeadBytes = {{{0x00, 0x7f, 0, 0, 1},
                                                  {0xc2, 0xdf, 0x80, 0xbf, 2},
                                                  {0xe0, 0xe0, 0xa0, 0xbf, 3},
                                                  {0xe1, 0xec, 0x80, 0xbf, 3},
                                                  {0xed, 0xed, 0x80, 0x9f, 3},
                                                  {0xee, 0xef, 0x80, 0xbf, 3},
                                                  {0xf0, 0xf0, 0x90, 0xbf, 4},
                                                  {0xf1, 0xf3, 0x80, 0xbf, 4},
                                                  {0xf4, 0xf4, 0x80, 0x8f, 4}}};

bool has_valid_tail(std::string_view text, const LeadBytes& lead) {
  if (text.size() < lead.length) return false;
  if (lead.length == 1) return true;
  const unsigned second = byte_at(text, 1);
  if (second < lead.second_first || second > lead.second_last) return false;
  for (std::size_t i = 2; i < lead.length; ++i) {
    if ((byte_at(text, i) & 0xc0U) != 0x80U) return false;
  }
  return true;
}

/// \return the length in bytes of the character at the start of `text`; 0 if it is not UTF-8
std::size_t character_length(std::string_view text) {
  const unsigned first = byte_at(text, 0);
  for (const LeadBytes& lead : kLeadBytes) {
    if (first < lead.first || first > lead.last) continue;
    return has_valid_tail(text, lead) ? lead.length : 0;
  }
  return 0;
}

constexpr std::string_view kDigits = "0123456789abcdef";

std::string escaped_byte(unsigned byte) {
  return {'\\', 'x', kDigits[byte >> 4U], kDigits[byte & 0xfU]};
}

/// Formats a code unit as in JSON: "\u202e".
std::string escaped_unit(unsigned code) {
  return {'\\',
          'u',
          kDigits[code >> 12U & 0xfU],
          kDigits[code >> 8U & 0xfU],
          kDigits[code >> 4U & 0xfU],
          kDigits[code & 0xfU]};
}

/// The code of a character of at most three bytes.
unsigned code_of(std::string_view character) {
  const auto low_bits = [&](std::size_t index) { return byte_at(character, index) & 0x3fU; };
  if (character.size() == 1) return byte_at(character, 0);
  if (character.size() == 2) return (byte_at(character, 0) & 0x1fU) << 6U | low_bits(1);
  return (byte_at(character, 0) & 0x0fU) << 12U | low_bits(1) << 6U | low_bits(2);
}

bool is_control(unsigned code) {
  return code < 0x20 || code == 0x7f;
}

/// Whether the code is a C1 control (U+0080 to U+009F), which some terminals obey; a line
/// separator; or a bidirectional control, which changes the display order (Unicode 15, 23.2).
bool is_misleading(unsigned code) {
  return (code >= 0x80 && code < 0xa0) || code == 0x61c || code == 0x200e || code == 0x200f ||
         (code >= 0x2028 && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
}

/// \param code  of a control character below U+0080
std::string shown_control(unsigned code, Controls controls) {
  if (controls == Controls::as_spaces) return " ";
  if (code == '\n' || code == '\t') return {static_cast<char>(code)};
  return escaped_unit(code);
}

}  // namespace

std::string printable(std::string_view text, Controls controls) {
  std::string clean;
  clean.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    const unsigned code = length == 0 || length > 3 ? 0x20U : code_of(text.substr(0, length));
    if (length == 0) {
      clean += escaped_byte(byte_at(text, 0));
    } else if (is_control(code)) {
      clean += shown_control(code, controls);
    } else if (is_misleading(code)) {
      clean += escaped_unit(code);
    } else {
      clean += text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return clean;
}

}  // namespace touchtrial
