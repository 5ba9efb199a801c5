/// \file The interface to the experimenter, who sees a session's state but never what is presented.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::session {

/// Compared with the instructions of participants.
enum class HandLevel { low, right, high };

/// How the hand presses across the plane and strokes along it.
struct HandLevels {
  HandLevel force = HandLevel::right;
  HandLevel speed = HandLevel::right;

  friend bool operator==(const HandLevels&, const HandLevels&) = default;
};

/// What the experimenter is shown. Nothing in it depends on a stimulus or an outcome.
struct SessionStatus {
  std::string participant{};
  /// "day sheet", "instructions", "practice", "ready", "exploring", "answering", ...
  std::string stage{};
  /// As in the participant's window: presentations begun, including the current and the announced
  /// one; in practice, those of the round. 0: none yet.
  int trial = 0;
  int of = 0;  ///< presentations in all, with repetitions; in practice, of the round
  bool practice = false;
  bool participant_stopped = false;    ///< a comfort stop of the participant is pending
  bool needs_consent = false;          ///< no force before the experimenter consents
  std::chrono::nanoseconds elapsed{};  ///< since the session's opening
  std::string device{};                ///< its name, and what it needs
  std::string alert{};                 ///< what a person must do now; empty: nothing
  /// Set while a plane is on in real time and the hand is at it.
  std::optional<HandLevels> hand{};
  // Of the last exploration in real time.
  double rate_hz = 0.0;
  double lateness_p99_us = 0.0;
  std::int64_t overruns = 0;
  int interruptions = 0;  ///< of the session
};

/// A request of the experimenter, possible at any time.
struct ExperimenterRequest {
  enum class Kind {
    pause,         ///< `text` is the reason
    resume,        ///< ends a pause
    comfort_stop,  ///< zero force within 100 ms; the trial is recorded as interrupted, and a reason
                   ///< in `text` as the deviation kComfortStopCode
    note,          ///< `text`
    deviation,     ///< `code`, and `text` which may be empty
    delay,  ///< a deviation that delayed the session: the current presentation counts as after a
            ///< pause
    abort,  ///< `text` is the reason; the session is stopped and closed
    leave,  ///< the program has to end for the reason in `text`; the session stays open and can be
            ///< resumed
  };
  Kind kind{};
  std::string text;
  std::string code;
};

/// Code of the deviation whose text is the reason for a comfort stop.
inline constexpr const char* kComfortStopCode = "comfort-stop";

/// An item of the day sheet.
struct DaySheetItem {
  std::string code;  ///< of the deviation if it is skipped; for instance "no-curtain"
  std::string text;
};
enum class Tick { done, skipped };

/// Called on the session's thread. No function waits for the person.
class Experimenter {
 public:
  virtual ~Experimenter() = default;

  /// Shows the session's state; called at every change and several times a second.
  virtual void show(const SessionStatus& /*status*/) {}
  /// Returns the requests one by one, each once; empty: there is none.
  [[nodiscard]] virtual std::optional<ExperimenterRequest> request() { return std::nullopt; }
  /// Asks for the day sheet before the participant sits down. Called repeatedly until there is a
  /// reply. The default replies without a tick, and nothing is recorded.
  /// \return the state of each item, in order
  [[nodiscard]] virtual std::optional<std::vector<Tick>> day_sheet(
      const std::vector<DaySheetItem>& /*items*/) {
    return std::vector<Tick>{};
  }
  /// Called when the response of a presentation is durable.
  /// \param trial  its number
  virtual void acknowledged(int /*trial*/) {}
};

}  // namespace touchtrial::session
