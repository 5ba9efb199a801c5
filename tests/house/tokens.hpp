/// \file The tokens of a C++ file, without comments, directives and what `#if 0` leaves out.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::house {

using Tokens = std::vector<std::string>;

struct TokensOfFile {
  Tokens tokens;                      ///< words, literals and signs; a raw string is ""
  std::vector<std::string> includes;  ///< as written: "a.hpp" or <a>, with these marks
};

[[nodiscard]] TokensOfFile tokens_of(std::string_view text);

/// Whether a token is a word: a name, a keyword or a number.
[[nodiscard]] bool is_name(const std::string& token);

}  // namespace touchtrial::house
