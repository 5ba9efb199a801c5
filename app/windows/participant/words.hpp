/// \file The texts of the participant's window. UTF-8.
#pragma once

#include "study/session_plan.hpp"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::app {

/// The names of all texts, which are also their keys in the file of a language.
// clang-format off
#define TOUCHTRIAL_SCREEN_TEXTS(TEXT) \
  TEXT(trial_of)  /* progress */ \
  TEXT(practice_of)  /* the same in practice */ \
  TEXT(page_of) \
  TEXT(question_of) \
  TEXT(next) \
  TEXT(back) \
  TEXT(skip)  /* an optional question */ \
  TEXT(go_on)  /* the button "Continue" */ \
  TEXT(practice_title) \
  TEXT(practice_again_title)  /* second round */ \
  TEXT(practice_text) \
  TEXT(practice_text_blindfold)  /* where answers are spoken */ \
  TEXT(practice_text_intervals)  /* where a trial has several planes */ \
  TEXT(practice_text_rating)  /* where answers are ratings */ \
  TEXT(practice_again_text) \
  TEXT(practice_start) \
  TEXT(practice_over_title) \
  TEXT(practice_over_text) \
  TEXT(practice_over_text_feedback)  /* where trials have feedback too */ \
  TEXT(practice_over_text_rating) \
  TEXT(ready_title) \
  TEXT(ready_text) \
  TEXT(ready_text_mouse) \
  TEXT(ready_text_intervals) \
  TEXT(ready_text_intervals_mouse) \
  TEXT(ready_text_hand_off) \
  TEXT(ready_keys) \
  TEXT(interval_of)  /* the number of the next or current plane of a trial */ \
  TEXT(interval_text)  /* before it */ \
  TEXT(interval_text_mouse) \
  TEXT(interval_text_hand_off) \
  TEXT(exploring_interval)  /* while it is on */ \
  TEXT(exploring_interval_mouse) \
  TEXT(exploring_hand_off) \
  TEXT(exploring_mouse)  /* below the plane of the device "mouse" */ \
  TEXT(force) \
  TEXT(speed) \
  TEXT(too_hard) \
  TEXT(touch_first)  /* Enter was pressed before the surface was felt */ \
  TEXT(answer_title) \
  TEXT(answer_fits_title)  /* where textures are made by several methods */ \
  TEXT(answer_spoken_title) \
  TEXT(answer_spoken_text) \
  TEXT(answer_spoken_choice)  /* where choices are words */ \
  TEXT(time_is_up)  /* an answer is still required */ \
  TEXT(time_is_up_rating) \
  TEXT(no_response_title) \
  TEXT(no_response_text) \
  TEXT(rate_hint)  /* how to mark a line */ \
  TEXT(rate_hint_points)  /* where scales are numbers */ \
  TEXT(choose_hint)  /* before the choice */ \
  TEXT(changes_once)  /* after the choice, which may be changed once */ \
  TEXT(now_fixed)  /* after the change */ \
  TEXT(feel_again) \
  TEXT(scale_bar)  /* the legend of the bar of 10 mm */ \
  TEXT(scale_true) \
  TEXT(scale_shrunk) \
  TEXT(scale_unknown)  /* the size of the monitor is not known */ \
  TEXT(confidence_title) \
  TEXT(confidence_least) \
  TEXT(confidence_most) \
  TEXT(correct_title) \
  TEXT(wrong_title) \
  TEXT(your_answer) \
  TEXT(it_was) \
  TEXT(it_was_this) \
  TEXT(right_answer)  /* where choices are words */ \
  TEXT(break_title) \
  TEXT(break_text) \
  TEXT(break_done) \
  TEXT(pause_title) \
  TEXT(pause_text) \
  TEXT(stopped_title)  /* after a comfort stop */ \
  TEXT(stopped_text)  /* while the experimenter decides */ \
  TEXT(stopped_text_alone)  /* where the participant decides, with a mouse */ \
  TEXT(not_explored_title)  /* a trial is repeated */ \
  TEXT(not_explored_text) \
  TEXT(hand_off_title)  /* the hand leaves the device, which is only heard in the last trials */ \
  TEXT(hand_off_text) \
  TEXT(end_title) \
  TEXT(end_text) \
  TEXT(finish) \
  TEXT(number_hint) \
  TEXT(text_hint)
// clang-format on

/// All texts of the window in one language: the section "screens" of its file, whose keys are the
/// names of the members. Placeholders in braces ("{trial}") stand for numbers and labels.
struct Words {
#define TOUCHTRIAL_MEMBER(name) std::string name;
  TOUCHTRIAL_SCREEN_TEXTS(TOUCHTRIAL_MEMBER)
#undef TOUCHTRIAL_MEMBER
  std::map<std::string, std::string> by_key;  ///< the whole section, for keys that protocols name
};

/// \param texts  texts of one language, from study::texts_of
/// \throws std::out_of_range if one is missing
[[nodiscard]] Words words_of(const study::Texts& texts);

/// The title of an answer.
/// \param key  a key in "screens"; empty: the question which picture was felt. It must outlive the
///   result.
/// \return the key itself if there is no such text
[[nodiscard]] const std::string& title_of(const Words& words, const std::string& key);

/// The text of a choice that is a word, in the language of `words`.
/// \return the label itself if there is no text for it
[[nodiscard]] std::string choice_text(const Words& words, const std::string& label);

/// Replaces "{name}" in a text.
/// \param values  the replacements by name
[[nodiscard]] std::string fill_placeholders(
    std::string text, const std::vector<std::pair<std::string, std::string>>& values);
/// Replaces "{name}" by numbers.
[[nodiscard]] std::string fill_numbers(const std::string& text,
                                       const std::vector<std::pair<std::string, int>>& numbers);

}  // namespace touchtrial::app
