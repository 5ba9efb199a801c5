/// \file The texts of the participant's window, in German and English. UTF-8.
#pragma once

#include <string>

namespace touchtrial::app {

/// All texts of the window in one language. "{}" stands for a number.
struct Words {
  const char* trial_of;     ///< progress: trial, number of trials
  const char* practice_of;  ///< the same in practice
  const char* page_of;
  const char* question_of;
  const char* next;
  const char* back;
  const char* skip;  ///< an optional question
  const char* go_on;

  const char* practice_title;
  const char* practice_again_title;  ///< second round
  const char* practice_text;
  const char* practice_again_text;
  const char* practice_start;

  const char* ready_title;
  const char* ready_text;
  const char* ready_text_mouse;
  const char* ready_keys;

  const char* exploring_mouse;  ///< below the plane of the device "mouse"
  const char* force;
  const char* speed;
  const char* too_hard;

  const char* answer_title;
  const char* answer_spoken_title;
  const char* answer_spoken_text;
  const char* time_is_up;
  const char* choose_hint;   ///< before the choice; the last key
  const char* changes_once;  ///< after the choice, which may be changed once
  const char* now_fixed;     ///< after the change
  const char* feel_again;
  const char* scale_true;
  const char* scale_shrunk;   ///< per cent
  const char* scale_unknown;  ///< the monitor states no size

  const char* confidence_title;
  const char* confidence_least;
  const char* confidence_most;

  const char* correct_title;
  const char* wrong_title;
  const char* your_answer;
  const char* it_was;
  const char* it_was_this;

  const char* break_title;
  const char* break_text;
  const char* break_done;  ///< finished trials, number of trials

  const char* pause_title;
  const char* pause_text;

  const char* end_title;
  const char* end_text;
  const char* finish;

  const char* number_hint;
  const char* text_hint;
};

/// \param language  "de..." is German, anything else English
[[nodiscard]] const Words& words_in(const std::string& language);

}  // namespace touchtrial::app
