/// \file What a session puts before a person, one step at a time, and what they reply. Data alone:
/// a window draws it, a simulated participant answers it, a test scripts it. Nothing in a step
/// depends on what is presented.
#pragma once

#include "protocols/design/session_plan.hpp"

#include <chrono>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace touchtrial::session {

/// Pages to read, one after the other.
struct InstructionStep {
  std::vector<std::string> pages;
};

/// A questionnaire; the reply's `answers` are in its order: a choice's as the option's index from
/// 0, empty if it was left out.
struct QuestionStep {
  const design::Questionnaire* questionnaire = nullptr;  ///< outlives the step
};

/// Before a practice round: which textures there are, to be told apart with feedback.
struct PracticeStep {
  int round = 1;
};

/// Between trials: the plane comes on once the participant is ready.
struct ReadyStep {
  int trial = 0;  ///< how many of `of` this one is, from 1
  int of = 0;
  bool practice = false;
};

/// The pictures of `Participant::see_pictures`, one of which is chosen.
struct AnswerStep {
  int trial = 0;
  int of = 0;
  bool practice = false;
  bool time_is_up = false;
  bool may_explore_again = false;                ///< the reply may be `explore_again`
  int confidence_levels = 0;                     ///< 0: not asked
  design::Sight sight = design::Sight::curtain;  ///< blindfold: the answer is spoken
};

/// After a practice answer.
struct FeedbackStep {
  int answered = 0;  ///< position
  int correct = 0;   ///< position
};

struct BreakStep {
  int done = 0;
  int of = 0;
};

/// Somebody paused the session; it ends when they resume, and no reply is waited for.
struct PauseStep {};

struct EndStep {};

using Step = std::variant<InstructionStep, QuestionStep, PracticeStep, ReadyStep, AnswerStep,
                          FeedbackStep, BreakStep, PauseStep, EndStep>;

struct StepReply {
  /// When the person did it, on the servo's monotonic clock; nothing: now.
  std::optional<std::chrono::steady_clock::time_point> at;
  /// Virtual time that it took; real time has gone by.
  std::chrono::nanoseconds took{};
  bool explore_again = false;         ///< AnswerStep: back to the plane; the rest means nothing
  int position = 0;                   ///< AnswerStep
  std::optional<int> first_position;  ///< AnswerStep: the choice before a change
  std::optional<int> confidence;      ///< AnswerStep, if asked for: from 1
  std::vector<std::string> answers;   ///< QuestionStep
};

}  // namespace touchtrial::session
