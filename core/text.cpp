#include "core/text.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <string_view>

#include <utf8proc.h>

namespace touchtrial {

std::string skeleton_of(const std::string& name) {
  constexpr int kFolded = UTF8PROC_STABLE | UTF8PROC_COMPOSE | UTF8PROC_COMPAT | UTF8PROC_CASEFOLD |
                          UTF8PROC_IGNORE | UTF8PROC_LUMP;
  utf8proc_uint8_t* bytes = nullptr;
  const utf8proc_ssize_t size = utf8proc_map(reinterpret_cast<const utf8proc_uint8_t*>(name.data()),
                                             static_cast<utf8proc_ssize_t>(name.size()), &bytes,
                                             static_cast<utf8proc_option_t>(kFolded));
  const std::unique_ptr<utf8proc_uint8_t, decltype(&std::free)> owner(bytes, std::free);
  if (size < 0) return name;
  std::string folded(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size));
  std::erase_if(folded, [](char c) { return c == ' ' || c == '-'; });
  return folded;
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
