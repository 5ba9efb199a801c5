/// \file Parses, compares and joins texts.
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace touchtrial {

/// Parses the entire text as a number, independent of the locale; nothing if it is not a number.
template <typename Number>
[[nodiscard]] std::optional<Number> number_in(std::string_view text) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return number;
}

/// Reduces a name to what a reader can distinguish. Ignores case, blanks and hyphens of any kind,
/// the encoding of accents, wide and other forms of a letter, and the difference between Latin
/// letters and Cyrillic or Greek letters that look like them, as small letters or as capitals.
/// Names with equal skeletons look alike, and some file systems do not distinguish them.
/// \return the text itself if it is not UTF-8
/// Source: Unicode Standard Annex 15 and its case folding.
[[nodiscard]] std::string skeleton_of(const std::string& name);

/// Whether spreadsheets, pandas or R read a text as a missing value or a truth value, by default:
/// NA, NaN, NULL, None, TRUE and the like, in upper or lower case.
[[nodiscard]] bool is_read_as_missing(const std::string& text);

/// Whether a spreadsheet would read a text as a formula, so that exports must put an apostrophe
/// before it. Such a text begins with =, +, -, @, a tab or a carriage return. Source: OWASP, "CSV
/// Injection".
[[nodiscard]] bool begins_like_formula(std::string_view text) noexcept;

/// "1 session", "3 sessions"
[[nodiscard]] inline std::string counted(std::int64_t n, const std::string& noun) {
  return std::to_string(n) + " " + noun + (n == 1 ? "" : "s");
}

/// Digits in groups of four, for people to read and copy: "0f3a 91c2 77de".
[[nodiscard]] inline std::string in_groups_of_four(std::string_view digits) {
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && i % 4 == 0) text += ' ';
    text += digits[i];
  }
  return text;
}

/// Words with commas between them, for example "bark, brick and cork".
/// \param last_separator  between the last two words, for example " and "
/// \param text_of  returns the text of an element: a function or a member
template <typename Words, typename TextOf = std::identity>
[[nodiscard]] std::string listed(const Words& words, std::string_view last_separator = ", ",
                                 const TextOf& text_of = {}) {
  std::string text;
  std::size_t index = 0;
  for (const auto& word : words) {
    if (index > 0) text += index + 1 == std::size(words) ? last_separator : ", ";
    text += std::invoke(text_of, word);
    ++index;
  }
  return text;
}

}  // namespace touchtrial
