/// \file The participant, who feels planes and answers: the steps that a session shows, and the
/// replies.
#pragma once

#include "core/plane_geometry.hpp"
#include "device/haptic_device.hpp"
#include "device/servo/servo.hpp"
#include "device/servo/servo_control.hpp"
#include "study/ask.hpp"
#include "study/session_plan.hpp"

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace touchtrial::session {

/// Pages to read, one after the other.
struct InstructionStep {
  std::vector<std::string> pages;
};

struct QuestionStep {
  const study::Questionnaire* questionnaire = nullptr;  ///< outlives the step
  std::string_view typed{};  ///< initial text of the first field; ASCII; outlives the step
};

/// Announces a practice round.
struct PracticeStep {
  int round = 1;
};

/// Shown between trials. The plane is presented when the participant is ready.
struct ReadyStep {
  int trial = 0;  ///< from 1 to `total`
  int total = 0;
  bool practice = false;
  bool hand_off = false;  ///< the participant only hears the device
};

/// Shown before each plane of a trial with several planes, while the hand lifts off. It ends
/// automatically after the time needed to read it.
struct IntervalStep {
  int trial = 0;  ///< number in the schedule; in practice, in the round
  bool practice = false;
  int interval = 1;  ///< from 1 to `total`
  int total = 2;
  bool hand_off = false;
};

/// Asks for one of the choices of `Participant::see_pictures`, or for numbers on scales.
struct AnswerStep {
  int trial = 0;
  int total = 0;
  bool practice = false;
  bool time_is_up = false;
  bool may_explore_again = false;  ///< the reply may be `explore_again`
  int confidence_levels = 0;       ///< 0: not asked
  study::QuestionForm question{};
  std::string picture{};  ///< label of the picture shown with the question; empty: none
  study::Sight sight = study::Sight::curtain;  ///< blindfold: the answer is spoken
};

/// Shown after an answer in practice, or in trials with feedback.
struct FeedbackStep {
  int answered = 0;  ///< position of the chosen alternative
  int correct = 0;   ///< position of the right alternative
};

struct BreakStep {
  int done = 0;
  int total = 0;
};

/// Reports an event.
struct NoticeStep {
  enum class What {
    practice_over,  ///< the trials begin
    time_is_up,     ///< a presentation ended without an answer
    stopped,        ///< after a comfort stop; the force is off
    not_explored,   ///< an interval was not explored as instructed; its trial is repeated
    hand_off,       ///< from now on the hand is off the device, which can only be heard
  };
  What what{};
  int presentations = 0;  ///< number begun so far
  /// Whether a reply continues the session. If not, it continues once the experimenter consents to
  /// force.
  bool can_resume = true;
};

/// The session is paused until the experimenter resumes it; a reply has no effect.
struct PauseStep {};

struct EndStep {};

/// A page for the participant, as plain data: a window draws it, a simulated participant answers
/// it, and tests script it. Nothing in a step depends on the stimulus.
using Step = std::variant<InstructionStep, QuestionStep, PracticeStep, ReadyStep, IntervalStep,
                          AnswerStep, FeedbackStep, BreakStep, NoticeStep, PauseStep, EndStep>;

struct StepReply {
  /// When the participant replied, on the servo's monotonic clock; empty: now.
  std::optional<std::chrono::steady_clock::time_point> at;
  /// Duration of the reply in virtual time; ignored in real time.
  std::chrono::nanoseconds took{};
  bool explore_again =
      false;        ///< AnswerStep: the participant returns to the plane; members below are ignored
  Answer answer{};  ///< AnswerStep: the answer
  std::optional<int> confidence;  ///< AnswerStep: from 1, if requested
  /// QuestionStep, in the order of questions: for a choice the option's index from 0; empty if the
  /// question was skipped.
  std::vector<std::string> answers;
};

/// A participant. These calls are its only source of information: the pictures to choose from, the
/// extent of the blank plane (the same in every trial), and the device's forces. They never contain
/// a code, label or file name of a stimulus. All functions except `feel` and `note_plane_on` are
/// called on the session's thread.
class Participant {
 public:
  virtual ~Participant() = default;

  /// Called before the first trial, and before each practice round with the round's pictures.
  /// \param labels  the pictures' labels, by position
  virtual void see_pictures(const std::vector<std::string>& labels) = 0;

  /// Shows a step and polls for a reply. Called repeatedly with the same step until there is one.
  /// May block briefly, for instance to draw a screen.
  /// \return empty while there is no reply
  [[nodiscard]] virtual std::optional<StepReply> show_step(const Step& step) = 0;

  /// Called just before a plane is presented.
  /// \return the device with the participant's hand on it, in the plane frame; valid until the next
  ///   call. Its `read` may return `stopped` when the participant is done exploring.
  [[nodiscard]] virtual device::HapticDevice& begin_exploring(const PlaneGeometry& plane) = 0;

  /// In real time, called on the servo's thread just before its first tick: ticks count from
  /// `began`.
  virtual void note_plane_on(std::chrono::steady_clock::time_point /*began*/) noexcept {}

  /// Called repeatedly in real time while the plane is on. The participant calls `finish` when
  /// done, and `comfort_stop` to switch the force off.
  virtual void while_exploring(device::ServoControl& /*servo*/) {}

  /// Receives one sample of the servo. In virtual time called on the servo's thread; in real time
  /// on another thread, with a delay, but before the next step.
  virtual void feel(const device::ServoSample& sample) noexcept = 0;
};

}  // namespace touchtrial::session
