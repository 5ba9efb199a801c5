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
  std::string practice_again_text;
  std::string practice_start;
  std::string practice_over_title;
  std::string practice_over_text;

  std::string ready_title;
  std::string ready_text;
  std::string ready_text_mouse;
  std::string ready_keys;

  std::string exploring_mouse;  ///< below the plane of the device "mouse"
  std::string force;
  std::string speed;
  std::string too_hard;
  std::string touch_first;  ///< Enter was pressed before the surface was felt

  std::string answer_title;
  std::string answer_fits_title;  ///< where textures are made by several methods
  std::string answer_spoken_title;
  std::string answer_spoken_text;
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

  std::string break_title;
  std::string break_text;
  std::string break_done;

  std::string pause_title;
  std::string pause_text;

  std::string stopped_title;       ///< after a comfort stop
  std::string stopped_text;        ///< while the experimenter decides
  std::string stopped_text_alone;  ///< where the participant decides, with a mouse

  std::string end_title;
  std::string end_text;
  std::string finish;

  std::string number_hint;
  std::string text_hint;
};

/// \param texts  a language's, as design::texts_of gives them
/// \throws std::out_of_range if one is missing
[[nodiscard]] Words words_of(const design::Texts& texts);

/// \param values  what stands in the place of "{name}", by name
[[nodiscard]] std::string filled(std::string text,
                                 const std::vector<std::pair<std::string, std::string>>& values);
/// The same with numbers.
[[nodiscard]] std::string with_numbers(const std::string& text,
                                       const std::vector<std::pair<std::string, int>>& numbers);

}  // namespace touchtrial::app
