#include "core/errors.hpp"

#include <array>
#include <cstddef>
#include <string_view>

namespace touchtrial {
namespace {

unsigned byte_at(std::string_view text, std::size_t at) {
  return static_cast<unsigned char>(text[at]);
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

bool continues(std::string_view rest, const LeadBytes& lead) {
  if (rest.size() < lead.length) return false;
  if (lead.length == 1) return true;
  const unsigned second = byte_at(rest, 1);
  if (second < lead.second_first || second > lead.second_last) return false;
  for (std::size_t i = 2; i < lead.length; ++i) {
    if ((byte_at(rest, i) & 0xc0U) != 0x80U) return false;
  }
  return true;
}

/// \return the length in bytes of the character at the start of `rest`; 0 if it is not UTF-8
std::size_t character_length(std::string_view rest) {
  const unsigned first = byte_at(rest, 0);
  for (const LeadBytes& lead : kLeadBytes) {
    if (first < lead.first || first > lead.last) continue;
    return continues(rest, lead) ? lead.length : 0;
  }
  return 0;
}

std::string escaped(unsigned byte) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  return {'\\', 'x', kDigits[byte >> 4U], kDigits[byte & 0xfU]};
}

bool is_control(unsigned byte) {
  return byte < 0x20 || byte == 0x7f;
}

}  // namespace

std::string one_line(const std::string& text) {
  std::string line;
  line.reserve(text.size());
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::size_t length = character_length(rest);
    if (length == 0) {
      line += escaped(byte_at(rest, 0));
    } else if (is_control(byte_at(rest, 0))) {
      line += ' ';
    } else {
      line += rest.substr(0, length);
    }
    rest.remove_prefix(length == 0 ? 1 : length);
  }
  return line;
}

}  // namespace touchtrial
