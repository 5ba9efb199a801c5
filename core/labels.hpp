/// \file What names may be, so that tables, screens and other programs can show them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace touchtrial {

[[nodiscard]] bool is_utf8(std::string_view text);

/// The letters of a text that other letters can look like: those with capitals.
struct Alphabets {
  bool latin = false;
  bool other = false;              ///< Greek, Cyrillic, ...
  bool one_word_has_both = false;  ///< so that nobody can tell which letters it has
};

[[nodiscard]] Alphabets alphabets_of(std::string_view text);

/// Whether a text contains a C0 character (line feeds and tabs included), DEL, or a C1 character.
[[nodiscard]] bool has_control_character(std::string_view text);

/// Why tables, screens and other programs could not show a text as the label of a class: the rest
/// of a sentence that starts with the label; empty if they can. A label has 1 to 64 bytes.
[[nodiscard]] std::string fault_of_label(const std::string& label);

/// What a person should look at if labels of one study have Latin letters, and others those of
/// another alphabet, of which skeleton_of compares only some; else empty.
[[nodiscard]] std::string remark_on_alphabets(const std::vector<std::string>& labels);

/// The text that one remark is about several of: the first by name, the others by number.
/// \param texts  at least one
[[nodiscard]] std::string first_of(const std::vector<std::string>& texts);

}  // namespace touchtrial
