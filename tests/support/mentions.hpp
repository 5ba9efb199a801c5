/// \file Whether a message names what it must, whatever its wording.
#pragma once

#include <cctype>
#include <sstream>
#include <string>

namespace touchtrial {

/// Whether a text holds these words in this order, with anything between them. Words that begin or
/// end with a digit do not stand within a longer number.
/// \param words  places, names, numbers and units, separated by blanks
[[nodiscard]] inline bool mentions(const std::string& text, const std::string& words) {
  const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  std::istringstream in(words);
  std::size_t from = 0;
  for (std::string word; in >> word;) {
    std::size_t at = text.find(word, from);
    while (at != std::string::npos) {
      const std::size_t end = at + word.size();
      const bool is_cut_before = at > 0 && is_digit(word.front()) && is_digit(text[at - 1]);
      const bool is_cut_after = end < text.size() && is_digit(word.back()) && is_digit(text[end]);
      if (!is_cut_before && !is_cut_after) break;
      at = text.find(word, at + 1);
    }
    if (at == std::string::npos) return false;
    from = at + word.size();
  }
  return true;
}

}  // namespace touchtrial
