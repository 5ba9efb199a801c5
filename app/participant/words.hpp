/// \file What the participant's window says, in German and English. UTF-8.
#pragma once

#include <string>

namespace touchtrial::app {

/// All the window's own words in one language. Where a number goes, "{}" stands.
struct Words {
  const char* trial_of;     ///< progress: of, all
  const char* practice_of;  ///< progress in practice: of, all
  const char* page_of;
  const char* question_of;
  const char* next;
  const char* back;
  const char* skip;  ///< a question that may be left out
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
  const char* choose_hint;   ///< nothing chosen yet; the range of keys
  const char* changes_once;  ///< chosen; may be changed once
  const char* now_fixed;     ///< changed
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
  const char* break_done;  ///< done, of

  const char* pause_title;
  const char* pause_text;

  const char* end_title;
  const char* end_text;
  const char* finish;

  const char* number_hint;
  const char* text_hint;
  const char* required;
};

/// \param language  "de..." is German, anything else English
[[nodiscard]] const Words& words_in(const std::string& language);

}  // namespace touchtrial::app
