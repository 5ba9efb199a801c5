#include "app/windows/participant/words.hpp"

#include <utility>

namespace touchtrial::app {
namespace {

constexpr std::pair<const char*, std::string Words::*> kWords[] = {
#define TOUCHTRIAL_ENTRY(name) {#name, &Words::name},
    TOUCHTRIAL_SCREEN_TEXTS(TOUCHTRIAL_ENTRY)
#undef TOUCHTRIAL_ENTRY
};

}  // namespace

Words words_of(const study::Texts& texts) {
  const auto& screens = texts.at("screens");
  Words words;
  for (const auto& [key, member] : kWords) words.*member = screens.at(key);
  words.by_key = screens;
  return words;
}

const std::string& title_of(const Words& words, const std::string& key) {
  if (key.empty()) return words.answer_title;
  const auto text = words.by_key.find(key);
  return text != words.by_key.end() ? text->second : key;
}

std::string choice_text(const Words& words, const std::string& label) {
  const auto text = words.by_key.find("choice_" + label);
  return text != words.by_key.end() ? text->second : label;
}

std::string fill_placeholders(std::string text,
                              const std::vector<std::pair<std::string, std::string>>& values) {
  for (const auto& [name, value] : values) {
    const std::string placeholder = "{" + name + "}";
    for (auto start = text.find(placeholder); start != text.npos;
         start = text.find(placeholder, start + value.size())) {
      text.replace(start, placeholder.size(), value);
    }
  }
  return text;
}

std::string fill_numbers(const std::string& text,
                         const std::vector<std::pair<std::string, int>>& numbers) {
  std::vector<std::pair<std::string, std::string>> values;
  for (const auto& [name, number] : numbers) values.emplace_back(name, std::to_string(number));
  return fill_placeholders(text, values);
}

}  // namespace touchtrial::app
