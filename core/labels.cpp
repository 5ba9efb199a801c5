#include "core/labels.hpp"

#include "core/errors.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"

#include <array>

#include <utf8proc.h>

namespace touchtrial {
namespace {

/// Removes the first character of a text.
/// \return its code point; negative if it is not UTF-8, and `text` is then empty
utf8proc_int32_t take_character(std::string_view& text) {
  utf8proc_int32_t character = -1;
  const utf8proc_ssize_t size =
      utf8proc_iterate(reinterpret_cast<const utf8proc_uint8_t*>(text.data()),
                       static_cast<utf8proc_ssize_t>(text.size()), &character);
  text.remove_prefix(size > 0 ? static_cast<std::size_t>(size) : text.size());
  return character;
}

/// The lower-case letter without accents.
utf8proc_int32_t base_letter(utf8proc_int32_t letter) {
  std::array<utf8proc_int32_t, 8> parts{letter};
  static_cast<void>(
      utf8proc_decompose_char(letter, parts.data(), parts.size(), UTF8PROC_DECOMPOSE, nullptr));
  return utf8proc_tolower(parts[0]);
}

}  // namespace

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    if (take_character(text) < 0) return false;
  }
  return true;
}

Alphabets alphabets_of(std::string_view text) {
  constexpr utf8proc_int32_t kFirstAfterLatin = 0x250;  // where the blocks of Latin letters end
  Alphabets all;
  Alphabets word;
  while (!text.empty()) {
    const utf8proc_int32_t character = take_character(text);
    const utf8proc_category_t kind = utf8proc_category(character);
    if (kind == UTF8PROC_CATEGORY_MN) continue;  // an accent
    if (kind != UTF8PROC_CATEGORY_LU && kind != UTF8PROC_CATEGORY_LL) {
      word = {};
      continue;
    }
    (base_letter(character) < kFirstAfterLatin ? word.latin : word.non_latin) = true;
    all.latin |= word.latin;
    all.non_latin |= word.non_latin;
    all.mixed_in_one_word |= word.latin && word.non_latin;
  }
  return all;
}

bool has_control_character(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c < 0x20 || c == 0x7f) return true;
    // C1 is 0xC2 0x80 .. 0xC2 0x9F in UTF-8.
    const bool c1 =
        c == 0xc2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xa0;
    if (c1) return true;
  }
  return false;
}

std::string fault_of_label(const std::string& label) {
  constexpr std::size_t kMaxBytes = 64;
  if (label.empty()) return "is empty";
  if (!is_utf8(label)) return "is not UTF-8";
  if (label.size() > kMaxBytes) {
    return "has " + std::to_string(label.size()) + " bytes, must have at most " +
           std::to_string(kMaxBytes);
  }
  if (has_control_character(label)) return "has a control character";
  if (label.front() == ' ' || label.back() == ' ') return "begins or ends with a blank";
  if (is_read_as_missing(label)) return "is read by other programs as a missing or truth value";
  if (begins_like_formula(label)) return "begins like a formula";
  if (alphabets_of(label).mixed_in_one_word) {
    return "mixes Latin letters with those of another alphabet in one word";
  }
  return "";
}

std::string remark_on_alphabets(const std::vector<std::string>& labels) {
  std::vector<std::string> latin;
  std::vector<std::string> non_latin;
  for (const std::string& label : labels) {
    const Alphabets alphabets = alphabets_of(label);
    if (alphabets.latin) latin.push_back(in_quotes(label));
    if (alphabets.non_latin) non_latin.push_back(in_quotes(label));
  }
  if (latin.empty() || non_latin.empty()) return "";
  return "labels have Latin letters (" + first_and_count(latin) + ") and others (" +
         first_and_count(non_latin) + "); check whether any two look alike, and rename one";
}

std::string first_and_count(const std::vector<std::string>& texts) {
  const std::size_t more = texts.size() - 1;
  return one_line(texts.front()) + (more > 0 ? " and " + std::to_string(more) + " more" : "");
}

}  // namespace touchtrial
