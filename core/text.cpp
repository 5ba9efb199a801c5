#include "core/text.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <string_view>

#include <utf8proc.h>

namespace touchtrial {

namespace {

/// Small letters that look like Latin letters, or whose capitals do. The Greek m is not among them,
/// because it is also the prefix micro, and um must differ from mm.
constexpr std::u32string_view kCyrillicAndGreek =
    U"\u0430\u0432\u0435\u043a\u043c\u043d\u043e\u0440\u0441\u0442\u0443\u0445\u0455\u0456\u0458"
    U"\u0501\u04bb\u051b\u051d\u03b1\u03b2\u03b5\u03b6\u03b7\u03b9\u03ba\u03bd\u03bf\u03c1\u03c4"
    U"\u03c5\u03c7";
constexpr std::string_view kLatinLookAlikes = "abekmhopctyxsijdhqwabezhiknoptyx";
static_assert(kCyrillicAndGreek.size() == kLatinLookAlikes.size());

/// Replaces look-alikes by their Latin letters.
std::string to_latin(const std::string& text) {
  std::string latin;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const bool has_two_bytes = (lead & 0xe0U) == 0xc0U;
    const char32_t letter =
        has_two_bytes ? (lead & 0x1fU) << 6U | (static_cast<unsigned char>(text[i + 1]) & 0x3fU)
                      : U'\0';
    if (const std::size_t index = kCyrillicAndGreek.find(letter);
        index != std::u32string_view::npos) {
      latin += kLatinLookAlikes[index];
      ++i;
    } else {
      latin += text[i];
    }
  }
  return latin;
}

}  // namespace

std::string skeleton_of(const std::string& name) {
  // Decomposition separates a letter from its accents.
  constexpr int kOptions = UTF8PROC_STABLE | UTF8PROC_DECOMPOSE | UTF8PROC_COMPAT |
                           UTF8PROC_CASEFOLD | UTF8PROC_IGNORE | UTF8PROC_LUMP;
  utf8proc_uint8_t* bytes = nullptr;
  const utf8proc_ssize_t size = utf8proc_map(reinterpret_cast<const utf8proc_uint8_t*>(name.data()),
                                             static_cast<utf8proc_ssize_t>(name.size()), &bytes,
                                             static_cast<utf8proc_option_t>(kOptions));
  const std::unique_ptr<utf8proc_uint8_t, decltype(&std::free)> owner(bytes, std::free);
  if (size < 0) return name;
  std::string skeleton(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size));
  std::erase_if(skeleton, [](char c) { return c == ' ' || c == '-'; });
  return to_latin(skeleton);
}

bool begins_like_formula(std::string_view text) noexcept {
  return !text.empty() && std::string_view("=+-@\t\r").find(text.front()) != std::string_view::npos;
}

bool is_read_as_missing(const std::string& text) {
  static constexpr std::array<std::string_view, 13> kWords = {
      "na",   "n/a",  "<na>", "#n/a",  "#na",    "nan",    "-nan",
      "null", "none", "true", "false", "#null!", "#value!"};
  std::string lower = text;
  std::ranges::transform(lower, lower.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return std::ranges::find(kWords, lower) != kWords.end();
}

}  // namespace touchtrial
