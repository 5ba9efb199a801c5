/// \file The experimenter's interface: actions, questions, and status. Terminal and window are two
///   faces of one desk with the same functions.
///
///     ExperimenterDesk desk(true);
///     TerminalFace terminal(desk, standard_terminal());
///     ParticipantWindowOptions options;
///     options.console = &desk;      // the experimenter's window
///     options.console_monitor = 2;  // without it, the system chooses the place
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
  enum class What { pause, resume, comfort_stop, note, deviation, abort, arm, at_reset };
  What what{};
  char key = '\0';    ///< at the terminal
  const char* label;  ///< of the window's button
};

/// All actions, in the order of the buttons. Pause and comfort stop take effect at once; the reason
/// is asked for afterwards.
inline constexpr std::array<ExperimenterAction, 8> kExperimenterActions = {{
    {ExperimenterAction::What::pause, 'p', "Pause"},
    {ExperimenterAction::What::resume, 'r', "Resume"},
    {ExperimenterAction::What::comfort_stop, 'c', "Comfort stop"},
    {ExperimenterAction::What::note, 'n', "Note"},
    {ExperimenterAction::What::deviation, 'd', "Deviation"},
    {ExperimenterAction::What::abort, 'a', "Abort"},
    {ExperimenterAction::What::arm, 'g', "Force on"},
    {ExperimenterAction::What::at_reset, 'h', "Arm is here"},
}};

/// A question to the experimenter.
struct ExperimenterQuestion {
  enum class Kind {
    none,
    keys,    ///< one of the choices, each by its key
    number,  ///< one of the choices, by its number
    text,    ///< a line; choices are suggestions
    sure,    ///< the only choice, or none
  };
  struct Choice {
    std::string answer;
    std::string label{};  ///< empty: the answer itself
    char key = '\0';
  };
  Kind kind = Kind::none;
  std::string text{};
  std::vector<Choice> choices{};

  /// Whether the experimenter started it, and may discard it. It then hides the session's question.
  [[nodiscard]] bool is_own() const noexcept { return kind == Kind::text || kind == Kind::sure; }
};

/// The displayed state. Nothing in it depends on a stimulus or an outcome.
struct ExperimenterView {
  session::SessionStatus status;
  ExperimenterQuestion question;
  std::size_t questions = 0;        ///< changes when a new line starts
  std::string need;                 ///< what the device waits for
  std::deque<std::string> asked{};  ///< the experimenter's requests, newest first
  std::array<bool, kExperimenterActions.size()> may{};  ///< in the order of kExperimenterActions

  [[nodiscard]] bool allows(ExperimenterAction::What what) const noexcept {
    return may[static_cast<std::size_t>(what)];
  }
};

/// One display of the desk. All functions are called on the session's thread.
class ExperimenterFace {
 public:
  virtual ~ExperimenterFace() = default;
  /// Forwards new input.
  virtual void take_input() {}
  /// Called after every change, and several times a second.
  virtual void show(const ExperimenterView& view) = 0;
  /// Called before a line of standard output.
  virtual void make_room() {}
  /// Called while the session waits for a person: sleeps for a moment.
  virtual void rest() {}
};

/// An answer as the experimenter enters it for a blindfolded participant.
struct SpokenAnswer {
  std::size_t label = 0;             ///< index of the label that was chosen
  std::optional<std::size_t> first;  ///< the previous choice, if the participant changed it
  std::optional<int> confidence;
};

/// It has no access to stimuli or to the correctness of answers.
class ExperimenterDesk final : public session::Experimenter, public session::Attendant {
 public:
  using What = ExperimenterAction::What;

  /// \param is_attended  whether an experimenter is present; else no questions are asked
  explicit ExperimenterDesk(bool is_attended) : is_attended_(is_attended) {}

  /// \name Faces. Any thread.
  ///@{
  /// \param face  must be removed before it ends
  void add_face(ExperimenterFace& face);
  void remove_face(ExperimenterFace& face);
  ///@}

  /// \name The experimenter. Any thread.
  ///@{
  [[nodiscard]] ExperimenterView view() const;
  /// No effect if the action is not allowed now. Discards the open question of an earlier action.
  void act(What what);
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
  [[nodiscard]] Reply attend(const std::string& need) override;
  /// Call it repeatedly until there is an answer.
  /// \param labels  in alphabetical order, so that they reveal nothing about the presentation
  [[nodiscard]] std::optional<SpokenAnswer> spoken_answer(const session::AnswerStep& step,
                                                          const std::vector<std::string>& labels);
  /// Discards an unconfirmed spoken answer, because a plane is on.
  void forget_spoken_answer();
  ///@}

 private:
  enum class Own { none, pause_reason, stop_reason, note, code, remark, sure, abort_reason };
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
  void each_face(const std::function<void(ExperimenterFace&)>& work);
  void show_faces();
  // The following need the lock.
  [[nodiscard]] bool may(What what) const;
  [[nodiscard]] ExperimenterQuestion question() const;
  [[nodiscard]] ExperimenterQuestion own_question() const;
  void begin(Own own);
  void ask(Request::Kind kind, const std::string& text = {}, const std::string& code = {});
  void answer_own(const std::string& text);
  void answer_sheet(const std::string& text);
  void answer_spoken(const std::string& text);
  [[nodiscard]] Reply said(bool is_ready) const;

  const bool is_attended_;
  std::mutex faces_mutex_;
  std::vector<ExperimenterFace*> faces_;
  mutable std::mutex mutex_;  ///< guards all members below
  session::SessionStatus status_;
  std::deque<Request> requests_;
  std::deque<std::string> asked_;
  Own own_ = Own::none;
  std::size_t questions_ = 0;
  std::string code_;  ///< of the deviation being entered; in Own::code, a refused one
  std::optional<Sheet> sheet_;
  std::optional<Spoken> spoken_;
  bool is_pause_asked_ = false;
  bool waits_ = false;  ///< the device waits for need_, or for consent
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
  [[nodiscard]] std::optional<session::StepReply> attend(const session::Step& step) override;
  [[nodiscard]] device::HapticDevice& begin_exploring(const PlaneGeometry& plane) override {
    desk_.forget_spoken_answer();
    return participant_.begin_exploring(plane);
  }
  void exploring(device::ServoControl& servo) override { participant_.exploring(servo); }
  void feel(const device::ServoSample& sample) noexcept override { participant_.feel(sample); }

 private:
  session::Participant& participant_;
  ExperimenterDesk& desk_;
  std::vector<std::string> sorted_;
  std::vector<int> positions_;  ///< positions of the sorted labels in the participant's layout
};

}  // namespace touchtrial::app
