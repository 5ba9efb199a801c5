#include "app/participant/words.hpp"

#include <iterator>

namespace touchtrial::app {
namespace {

// clang-format off
constexpr std::pair<const char*, std::string Words::*> kWords[] = {
    {"trial_of", &Words::trial_of},
    {"practice_of", &Words::practice_of},
    {"page_of", &Words::page_of},
    {"question_of", &Words::question_of},
    {"next", &Words::next},
    {"back", &Words::back},
    {"skip", &Words::skip},
    {"go_on", &Words::go_on},
    {"practice_title", &Words::practice_title},
    {"practice_again_title", &Words::practice_again_title},
    {"practice_text", &Words::practice_text},
    {"practice_again_text", &Words::practice_again_text},
    {"practice_start", &Words::practice_start},
    {"practice_over_title", &Words::practice_over_title},
    {"practice_over_text", &Words::practice_over_text},
    {"ready_title", &Words::ready_title},
    {"ready_text", &Words::ready_text},
    {"ready_text_mouse", &Words::ready_text_mouse},
    {"ready_keys", &Words::ready_keys},
    {"exploring_mouse", &Words::exploring_mouse},
    {"force", &Words::force},
    {"speed", &Words::speed},
    {"too_hard", &Words::too_hard},
    {"touch_first", &Words::touch_first},
    {"answer_title", &Words::answer_title},
    {"answer_fits_title", &Words::answer_fits_title},
    {"answer_spoken_title", &Words::answer_spoken_title},
    {"answer_spoken_text", &Words::answer_spoken_text},
    {"time_is_up", &Words::time_is_up},
    {"no_response_title", &Words::no_response_title},
    {"no_response_text", &Words::no_response_text},
    {"choose_hint", &Words::choose_hint},
    {"changes_once", &Words::changes_once},
    {"now_fixed", &Words::now_fixed},
    {"feel_again", &Words::feel_again},
    {"scale_bar", &Words::scale_bar},
    {"scale_true", &Words::scale_true},
    {"scale_shrunk", &Words::scale_shrunk},
    {"scale_unknown", &Words::scale_unknown},
    {"confidence_title", &Words::confidence_title},
    {"confidence_least", &Words::confidence_least},
    {"confidence_most", &Words::confidence_most},
    {"correct_title", &Words::correct_title},
    {"wrong_title", &Words::wrong_title},
    {"your_answer", &Words::your_answer},
    {"it_was", &Words::it_was},
    {"it_was_this", &Words::it_was_this},
    {"break_title", &Words::break_title},
    {"break_text", &Words::break_text},
    {"break_done", &Words::break_done},
    {"pause_title", &Words::pause_title},
    {"pause_text", &Words::pause_text},
    {"stopped_title", &Words::stopped_title},
    {"stopped_text", &Words::stopped_text},
    {"stopped_text_alone", &Words::stopped_text_alone},
    {"end_title", &Words::end_title},
    {"end_text", &Words::end_text},
    {"finish", &Words::finish},
    {"number_hint", &Words::number_hint},
    {"text_hint", &Words::text_hint},
};
// clang-format on
static_assert(std::size(kWords) * sizeof(std::string) == sizeof(Words), "a member has no key");

}  // namespace

Words words_of(const design::Texts& texts) {
  const auto& screens = texts.at("screens");
  Words words;
  for (const auto& [key, member] : kWords) words.*member = screens.at(key);
  return words;
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
