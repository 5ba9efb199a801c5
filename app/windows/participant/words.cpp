#include "app/windows/participant/words.hpp"

#include <algorithm>
#include <iterator>

namespace touchtrial::app {
namespace {

constexpr std::pair<const char*, std::string Words::*> kWords[] = {
#define TOUCHTRIAL_ENTRY(name) {#name, &Words::name},
    TOUCHTRIAL_SCREEN_TEXTS(TOUCHTRIAL_ENTRY)
#undef TOUCHTRIAL_ENTRY
};

/// \return null if there is no such key
const std::string* find_text(const Words& words, const std::string& key) {
  const auto* const found =
      std::ranges::find(kWords, key, [](const auto& entry) { return std::string(entry.first); });
  return found == std::end(kWords) ? nullptr : &(words.*(found->second));
}

}  // namespace

Words words_of(const study::Texts& texts) {
  const auto& screens = texts.at("screens");
  Words words;
  for (const auto& [key, member] : kWords) words.*member = screens.at(key);
  return words;
}

const std::string& title_of(const Words& words, const std::string& key) {
  const std::string* const text = find_text(words, key);
  return text != nullptr ? *text : words.answer_title;
}

std::string choice_text(const Words& words, const std::string& label) {
  const std::string* const text = find_text(words, "choice_" + label);
  return text != nullptr ? *text : label;
}

std::string filled(std::string text,
                   const std::vector<std::pair<std::string, std::string>>& values) {
  for (const auto& [name, value] : values) {
    const std::string place = "{" + name + "}";
    for (auto at = text.find(place); at != text.npos; at = text.find(place, at + value.size())) {
      text.replace(at, place.size(), value);
    }
  }
  return text;
}

std::string with_numbers(const std::string& text,
                         const std::vector<std::pair<std::string, int>>& numbers) {
  std::vector<std::pair<std::string, std::string>> values;
  for (const auto& [name, number] : numbers) values.emplace_back(name, std::to_string(number));
  return filled(text, values);
}

}  // namespace touchtrial::app
