/// \file Rules for labels, so that tables, screens and other programs can show them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace touchtrial {

[[nodiscard]] bool is_utf8(std::string_view text);

/// The alphabets of a text's letters. Only alphabets with capitals count, because only they have
/// look-alikes.
struct Alphabets {
  bool latin = false;
  bool non_latin = false;          ///< Greek, Cyrillic, ...
  bool mixed_in_one_word = false;  ///< one word has both, which may mislead a reader
};

[[nodiscard]] Alphabets alphabets_of(std::string_view text);

/// Whether a text contains a control character: C0 (including line feed and tab), DEL or C1.
[[nodiscard]] bool has_control_character(std::string_view text);

/// Checks the label of a class; valid labels have 1 to 64 bytes.
/// \return the fault, a phrase that follows the label in a message; empty if there is none
[[nodiscard]] std::string fault_of_label(const std::string& label);

/// Checks whether labels of a study use different alphabets, because skeleton_of() recognises only
/// some look-alikes.
/// \return a remark, or empty
[[nodiscard]] std::string remark_on_alphabets(const std::vector<std::string>& labels);

/// Abbreviates several texts: "first and 2 more".
/// \param texts  at least one
[[nodiscard]] std::string first_and_count(const std::vector<std::string>& texts);

}  // namespace touchtrial
