#include "protocols/design/study_texts.hpp"

#include <algorithm>

namespace touchtrial::design {
namespace {

constexpr std::size_t kLongestQuestion = 500;  // bytes

void check_length(const JsonValue& place, const std::string& text, std::size_t longest) {
  if (text.size() <= longest) return;
  place.refuse("has " + std::to_string(text.size()) + " bytes, must have at most " +
               std::to_string(longest) + "; shorten it");
}

}  // namespace

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

std::string read_line(const JsonValue& place, std::size_t longest) {
  const std::string& line = place.text();
  if (line.empty()) place.refuse("is empty; write something, or leave it out");
  check_length(place, line, longest);
  if (has_control_character(line)) place.refuse("has a control character; remove it");
  if (line.front() == ' ' || line.back() == ' ') {
    place.refuse("begins or ends with a blank; remove it");
  }
  return line;
}

std::string read_paragraphs(const JsonValue& place, std::size_t longest) {
  const std::string& text = place.text();
  check_length(place, text, longest);
  std::string without_ends = text;
  std::erase(without_ends, '\n');
  if (has_control_character(without_ends)) {
    place.refuse("has a control character other than a line's end; remove it");
  }
  return text;
}

Translated read_translated(const JsonValue& place, const std::string& language) {
  const JsonObject object = place.object(kLanguages);
  Translated text;
  for (const std::string_view code : kLanguages) {
    if (const auto member = object.find(code)) {
      text[std::string(code)] = read_line(*member, kLongestQuestion);
    }
  }
  if (!text.contains(language)) {
    place.refuse_below("/" + language, "is missing, the study's language; add it");
  }
  return text;
}

}  // namespace touchtrial::design
