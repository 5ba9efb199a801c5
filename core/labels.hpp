/// \file Which labels are allowed, so that tables, screens and other programs can show them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace touchtrial {

[[nodiscard]] bool is_utf8(std::string_view text);

/// Which alphabets the letters of a text belong to; only alphabets with capitals have look-alikes.
struct Alphabets {
  bool latin = false;
  bool other = false;              ///< Greek, Cyrillic, ...
  bool one_word_has_both = false;  ///< so that readers cannot distinguish them
};

[[nodiscard]] Alphabets alphabets_of(std::string_view text);

/// Whether a text contains a C0 character (line feeds and tabs included), DEL, or a C1 character.
[[nodiscard]] bool has_control_character(std::string_view text);

/// Why tables, screens and other programs could not show a text as the label of a class: the rest
/// of a sentence that starts with the label; empty if they can. A label has 1 to 64 bytes.
[[nodiscard]] std::string fault_of_label(const std::string& label);

/// A remark if some labels of a study have Latin letters and others those of another alphabet,
/// because skeleton_of knows only some of the look-alikes; else empty.
[[nodiscard]] std::string remark_on_alphabets(const std::vector<std::string>& labels);

/// Several texts in short: the first, and how many more there are.
/// \param texts  at least one
[[nodiscard]] std::string first_of(const std::vector<std::string>& texts);

}  // namespace touchtrial
