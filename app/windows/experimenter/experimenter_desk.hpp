/// \file The experimenter's interface: actions, questions, and status. Terminal and window are two
///   faces of one desk with the same functions.
///
///     ExperimenterDesk desk(true);
///     TerminalFace terminal(desk, standard_terminal());
///     ParticipantWindowOptions options;
///     options.console = &desk;      // the experimenter's window
///     options.console_monitor = 2;  // otherwise the system places the window
///     ParticipantWindow window(options);
#pragma once

#include "protocols/session/device_station.hpp"
#include "protocols/session/experimenter.hpp"
#include "protocols/session/participant.hpp"

#include <array>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

/// An action that is possible at any time.
struct ExperimenterAction {
  enum class Kind { pause, resume, comfort_stop, note, deviation, abort, arm, at_reset };
  Kind kind{};
  char key = '\0';    ///< key at the terminal
  const char* label;  ///< text of the window's button
};

/// All actions, in the order of the buttons. Pause and comfort stop take effect at once; the reason
/// is asked for afterwards.
inline constexpr std::array<ExperimenterAction, 8> kExperimenterActions = {{
    {ExperimenterAction::Kind::pause, 'p', "Pause"},
    {ExperimenterAction::Kind::resume, 'r', "Resume"},
    {ExperimenterAction::Kind::comfort_stop, 'c', "Comfort stop"},
    {ExperimenterAction::Kind::note, 'n', "Note"},
    {ExperimenterAction::Kind::deviation, 'd', "Deviation"},
    {ExperimenterAction::Kind::abort, 'a', "Abort"},
    {ExperimenterAction::Kind::arm, 'g', "Force on"},
    {ExperimenterAction::Kind::at_reset, 'h', "Arm is here"},
}};

/// A question to the experimenter.
struct ExperimenterQuestion {
  enum class Kind {
    none,
    keys,     ///< asks for one of the choices by its key
    number,   ///< asks for one of the choices by its number
    text,     ///< asks for a line; choices are suggestions
    confirm,  ///< the only choice, or discard
  };
  struct Choice {
    std::string answer;
    std::string label{};  ///< empty: the answer itself
    char key = '\0';
  };
  Kind kind = Kind::none;
  std::string text{};
  std::vector<Choice> choices{};

  /// Whether the experimenter started it and may discard it. It hides the session's question.
  [[nodiscard]] bool is_from_experimenter() const noexcept {
    return kind == Kind::text || kind == Kind::confirm;
  }
};

/// The displayed state. Nothing in it depends on a stimulus or an outcome.
struct ExperimenterView {
  session::SessionStatus status;
  ExperimenterQuestion question;
  std::size_t question_number = 0;     ///< changes with every new question
  std::string need;                    ///< what the device is waiting for
  std::deque<std::string> requests{};  ///< the experimenter's, newest first
  std::array<bool, kExperimenterActions.size()>
      allowed{};  ///< in the order of kExperimenterActions

  [[nodiscard]] bool allows(ExperimenterAction::Kind kind) const noexcept {
    return allowed[static_cast<std::size_t>(kind)];
  }
};

/// One display of the desk. All functions are called on the session's thread.
class ExperimenterFace {
 public:
  virtual ~ExperimenterFace() = default;
  /// Forwards new input.
  virtual void read_input() {}
  /// Called after every change, and several times a second.
  virtual void show(const ExperimenterView& view) = 0;
  /// Called before a line of standard output.
  virtual void clear_line() {}
  /// Called while the session waits for a person: sleeps for a moment.
  virtual void sleep_briefly() {}
};

/// An answer as the experimenter enters it for a blindfolded participant.
struct SpokenAnswer {
  std::size_t label = 0;             ///< index of the label that was chosen
  std::optional<std::size_t> first;  ///< the first choice, if the participant changed it
  std::optional<int> confidence;
};

/// Collects the requests and answers of all faces. It has no access to stimuli or to the
/// correctness of answers.
class ExperimenterDesk final : public session::Experimenter, public session::Attendant {
 public:
  using Action = ExperimenterAction::Kind;

  /// \param is_attended  whether an experimenter is present; otherwise no questions are asked
  explicit ExperimenterDesk(bool is_attended) : is_attended_(is_attended) {}

  /// \name Faces. Any thread.
  ///@{
  /// \param face  must be removed before it is destroyed
  void add_face(ExperimenterFace& face);
  void remove_face(ExperimenterFace& face);
  ///@}

  /// \name The experimenter. Any thread.
  ///@{
  [[nodiscard]] ExperimenterView view() const;
  /// No effect if the action is not allowed now. Discards the open question of an earlier action.
  void act(Action action);
  /// Answers the open question; an invalid answer has no effect.
  void answer(const std::string& text);
  /// Discards the open question if the experimenter started it.
  void discard();
  /// Adds a request from another source, such as the sound.
  void add(const session::ExperimenterRequest& request);
  ///@}

  /// \name The session's thread
  ///@{
  void show(const session::SessionStatus& status) override;
  [[nodiscard]] std::optional<session::ExperimenterRequest> request() override;
  /// Returns an empty list at once if no experimenter is present.
  [[nodiscard]] std::optional<std::vector<session::Tick>> day_sheet(
      const std::vector<session::DaySheetItem>& items) override;
  void acknowledged(int trial) override;
  /// Force requires an action after an empty `need` was shown.
  [[nodiscard]] Reply poll(const std::string& need) override;
  /// Call it repeatedly until there is an answer.
  /// \param labels  in alphabetical order, so that they reveal nothing about the presentation
  [[nodiscard]] std::optional<SpokenAnswer> spoken_answer(const session::AnswerStep& step,
                                                          const std::vector<std::string>& labels);
  /// Discards an unconfirmed spoken answer, for instance because a plane comes on.
  void forget_spoken_answer();
  ///@}

 private:
  enum class ActionQuestion {
    none,
    pause_reason,
    stop_reason,
    note,
    code,
    remark,
    confirm,
    abort_reason
  };
  using Request = session::ExperimenterRequest;
  struct Sheet {
    std::vector<session::DaySheetItem> items;
    std::vector<session::Tick> ticks;
  };
  struct Spoken {
    session::AnswerStep step;
    std::vector<std::string> labels;
    std::optional<std::size_t> label{};
    std::optional<std::size_t> first{};
    bool is_confirmed = false;
    std::optional<int> confidence{};
  };

  /// Calls a function on every face, without holding the lock.
  void for_each_face(const std::function<void(ExperimenterFace&)>& work);
  void update_faces();
  // The following need the lock.
  [[nodiscard]] bool is_allowed(Action action) const;
  [[nodiscard]] ExperimenterQuestion question() const;
  [[nodiscard]] ExperimenterQuestion action_question() const;
  void open(ActionQuestion question);
  void add_request(Request::Kind kind, const std::string& text = {}, const std::string& code = {});
  void answer_action_question(const std::string& text);
  void answer_sheet(const std::string& text);
  void answer_spoken(const std::string& text);
  [[nodiscard]] Reply current_reply(bool is_ready) const;

  const bool is_attended_;
  std::mutex faces_mutex_;
  std::vector<ExperimenterFace*> faces_;
  mutable std::mutex mutex_;  ///< guards all members below
  session::SessionStatus status_;
  std::deque<Request> requests_;
  std::deque<std::string> shown_requests_;
  ActionQuestion action_question_ = ActionQuestion::none;
  std::size_t question_number_ = 0;
  std::string
      code_;  ///< code of the deviation being entered; in ActionQuestion::code, a refused one
  std::optional<Sheet> sheet_;
  std::optional<Spoken> spoken_;
  bool is_pause_requested_ = false;
  bool is_device_waiting_ = false;  ///< for need_, or for consent
  std::string need_;
  bool is_ready_shown_ = false;
  bool is_armed_ = false;
  bool is_at_reset_ = false;
};

/// Shows each step to `participant`, and takes the replies to spoken answers (sight "blindfold")
/// from the desk. Everything else comes from the participant.
class SpokenAnswers final : public session::Participant {
 public:
  /// \param participant,desk  must outlive this
  SpokenAnswers(session::Participant& participant, ExperimenterDesk& desk)
      : participant_(participant), desk_(desk) {}

  void see_pictures(const std::vector<std::string>& labels) override;
  [[nodiscard]] std::optional<session::StepReply> show_step(const session::Step& step) override;
  [[nodiscard]] device::HapticDevice& begin_exploring(const PlaneGeometry& plane) override {
    desk_.forget_spoken_answer();
    return participant_.begin_exploring(plane);
  }
  void while_exploring(device::ServoControl& servo) override {
    participant_.while_exploring(servo);
  }
  void feel(const device::ServoSample& sample) noexcept override { participant_.feel(sample); }

 private:
  session::Participant& participant_;
  ExperimenterDesk& desk_;
  std::vector<std::string> sorted_labels_;
  std::vector<int> positions_;  ///< positions of the sorted labels in the participant's layout
};

}  // namespace touchtrial::app
