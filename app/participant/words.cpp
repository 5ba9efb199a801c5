#include "app/participant/words.hpp"

#include <algorithm>
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
    {"practice_text_blindfold", &Words::practice_text_blindfold},
    {"practice_text_intervals", &Words::practice_text_intervals},
    {"practice_again_text", &Words::practice_again_text},
    {"practice_start", &Words::practice_start},
    {"practice_over_title", &Words::practice_over_title},
    {"practice_over_text", &Words::practice_over_text},
    {"practice_over_text_feedback", &Words::practice_over_text_feedback},
    {"ready_title", &Words::ready_title},
    {"ready_text", &Words::ready_text},
    {"ready_text_mouse", &Words::ready_text_mouse},
    {"ready_text_intervals", &Words::ready_text_intervals},
    {"ready_text_intervals_mouse", &Words::ready_text_intervals_mouse},
    {"ready_text_hand_off", &Words::ready_text_hand_off},
    {"ready_keys", &Words::ready_keys},
    {"interval_of", &Words::interval_of},
    {"interval_text", &Words::interval_text},
    {"interval_text_mouse", &Words::interval_text_mouse},
    {"interval_text_hand_off", &Words::interval_text_hand_off},
    {"exploring_interval", &Words::exploring_interval},
    {"exploring_interval_mouse", &Words::exploring_interval_mouse},
    {"exploring_hand_off", &Words::exploring_hand_off},
    {"exploring_mouse", &Words::exploring_mouse},
    {"force", &Words::force},
    {"speed", &Words::speed},
    {"too_hard", &Words::too_hard},
    {"touch_first", &Words::touch_first},
    {"answer_title", &Words::answer_title},
    {"answer_fits_title", &Words::answer_fits_title},
    {"answer_spoken_title", &Words::answer_spoken_title},
    {"answer_spoken_text", &Words::answer_spoken_text},
    {"answer_spoken_choice", &Words::answer_spoken_choice},
    {"threshold_texture", &Words::threshold_texture},
    {"threshold_stronger", &Words::threshold_stronger},
    {"threshold_coarser", &Words::threshold_coarser},
    {"threshold_odd", &Words::threshold_odd},
    {"threshold_same", &Words::threshold_same},
    {"choice_first", &Words::choice_first},
    {"choice_second", &Words::choice_second},
    {"choice_third", &Words::choice_third},
    {"choice_same", &Words::choice_same},
    {"choice_different", &Words::choice_different},
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
    {"right_answer", &Words::right_answer},
    {"break_title", &Words::break_title},
    {"break_text", &Words::break_text},
    {"break_done", &Words::break_done},
    {"pause_title", &Words::pause_title},
    {"pause_text", &Words::pause_text},
    {"stopped_title", &Words::stopped_title},
    {"stopped_text", &Words::stopped_text},
    {"stopped_text_alone", &Words::stopped_text_alone},
    {"not_explored_title", &Words::not_explored_title},
    {"not_explored_text", &Words::not_explored_text},
    {"hand_off_title", &Words::hand_off_title},
    {"hand_off_text", &Words::hand_off_text},
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

namespace {

/// \return null if there is no such key
const std::string* find_text(const Words& words, const std::string& key) {
  const auto* const found =
      std::ranges::find(kWords, key, [](const auto& entry) { return std::string(entry.first); });
  return found == std::end(kWords) ? nullptr : &(words.*(found->second));
}

}  // namespace

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
