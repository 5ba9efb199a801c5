/// \file The texts of the participant's window. UTF-8.
#pragma once

#include "protocols/design/session_plan.hpp"

#include <string>
#include <utility>
#include <vector>

namespace touchtrial::app {

/// All texts of the window in one language: the section "screens" of its file, whose keys are the
/// names of the members. Words in braces ("{trial}") stand for numbers and labels.
struct Words {
  std::string trial_of;     ///< progress
  std::string practice_of;  ///< the same in practice
  std::string page_of;
  std::string question_of;
  std::string next;
  std::string back;
  std::string skip;  ///< an optional question
  std::string go_on;

  std::string practice_title;
  std::string practice_again_title;  ///< second round
  std::string practice_text;
  std::string practice_text_blindfold;  ///< where answers are spoken
  std::string practice_text_intervals;  ///< where a trial has several planes
  std::string practice_again_text;
  std::string practice_start;
  std::string practice_over_title;
  std::string practice_over_text;
  std::string practice_over_text_feedback;  ///< where answers are told in trials too

  std::string ready_title;
  std::string ready_text;
  std::string ready_text_mouse;
  std::string ready_text_intervals;
  std::string ready_text_intervals_mouse;
  std::string ready_text_hand_off;
  std::string ready_keys;

  std::string interval_of;    ///< which plane of a trial comes next, or is on
  std::string interval_text;  ///< before it
  std::string interval_text_mouse;
  std::string interval_text_hand_off;
  std::string exploring_interval;  ///< while it is on
  std::string exploring_interval_mouse;
  std::string exploring_hand_off;

  std::string exploring_mouse;  ///< below the plane of the device "mouse"
  std::string force;
  std::string speed;
  std::string too_hard;
  std::string touch_first;  ///< Enter was pressed before the surface was felt

  std::string answer_title;
  std::string answer_fits_title;  ///< where textures are made by several methods
  std::string answer_spoken_title;
  std::string answer_spoken_text;
  std::string answer_spoken_choice;  ///< where choices are words
  std::string threshold_texture;     ///< titles that a protocol names by their keys
  std::string threshold_stronger;
  std::string threshold_coarser;
  std::string threshold_odd;
  std::string threshold_same;
  std::string choice_first;  ///< choices that are words
  std::string choice_second;
  std::string choice_third;
  std::string choice_same;
  std::string choice_different;
  std::string time_is_up;  ///< an answer is still required
  std::string no_response_title;
  std::string no_response_text;
  std::string choose_hint;   ///< before the choice
  std::string changes_once;  ///< after the choice, which may be changed once
  std::string now_fixed;     ///< after the change
  std::string feel_again;
  std::string scale_bar;  ///< what the bar of 10 mm shows
  std::string scale_true;
  std::string scale_shrunk;
  std::string scale_unknown;  ///< the size of the monitor is not known

  std::string confidence_title;
  std::string confidence_least;
  std::string confidence_most;

  std::string correct_title;
  std::string wrong_title;
  std::string your_answer;
  std::string it_was;
  std::string it_was_this;
  std::string right_answer;  ///< where choices are words

  std::string break_title;
  std::string break_text;
  std::string break_done;

  std::string pause_title;
  std::string pause_text;

  std::string stopped_title;       ///< after a comfort stop
  std::string stopped_text;        ///< while the experimenter decides
  std::string stopped_text_alone;  ///< where the participant decides, with a mouse

  std::string not_explored_title;  ///< a trial comes again
  std::string not_explored_text;
  std::string hand_off_title;  ///< from here on the device is only heard
  std::string hand_off_text;

  std::string end_title;
  std::string end_text;
  std::string finish;

  std::string number_hint;
  std::string text_hint;
};

/// \param texts  a language's, as design::texts_of gives them
/// \throws std::out_of_range if one is missing
[[nodiscard]] Words words_of(const design::Texts& texts);

/// The title of an answer.
/// \param key  in "screens"
/// \return that of an answer without a key if there is no such text
[[nodiscard]] const std::string& title_of(const Words& words, const std::string& key);

/// A choice that is a word, in the words' language.
/// \return the label itself if there is no text for it
[[nodiscard]] std::string choice_text(const Words& words, const std::string& label);

/// \param values  what stands in the place of "{name}", by name
[[nodiscard]] std::string filled(std::string text,
                                 const std::vector<std::pair<std::string, std::string>>& values);
/// The same with numbers.
[[nodiscard]] std::string with_numbers(const std::string& text,
                                       const std::vector<std::pair<std::string, int>>& numbers);

}  // namespace touchtrial::app
