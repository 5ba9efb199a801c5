/// \file The interface to the experimenter, who sees a session's state but never its stimuli.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::session {

/// A level relative to the participants' instructions.
enum class HandLevel { low, right, high };

/// Levels of the hand's force normal to the plane and its speed along the plane.
struct HandLevels {
  HandLevel force = HandLevel::right;
  HandLevel speed = HandLevel::right;

  friend bool operator==(const HandLevels&, const HandLevels&) = default;
};

/// The state that the experimenter sees. Nothing in it depends on a stimulus or an outcome.
struct SessionStatus {
  std::string participant{};
  /// "day sheet", "instructions", "practice", "ready", "exploring", "answering", ...
  std::string stage{};
  /// Number of the current or announced presentation, as in the participant's window; in practice,
  /// within the round. 0: none yet.
  int trial = 0;
  int total = 0;  ///< total of presentations, with repetitions; in practice, of the round
  bool practice = false;
  bool participant_stopped = false;    ///< a comfort stop of the participant is pending
  bool needs_consent = false;          ///< whether force waits for the experimenter's consent
  std::chrono::nanoseconds elapsed{};  ///< since the session's opening
  std::string device{};                ///< the device's name and condition
  std::string alert{};                 ///< an instruction to the experimenter; may be empty
  /// Set while a plane is on in real time and the hand is at it.
  std::optional<HandLevels> hand{};
  // These members describe the last exploration in real time.
  double rate_hz = 0.0;
  double lateness_p99_us = 0.0;
  std::int64_t overruns = 0;
  int interruptions = 0;  ///< of the session
};

/// A request of the experimenter, at any time.
struct ExperimenterRequest {
  enum class Kind {
    pause,         ///< `text` is the reason
    resume,        ///< ends a pause
    comfort_stop,  ///< zero force within 100 ms; the trial is recorded as interrupted, and `text`,
                   ///< if not empty, as the deviation kComfortStopCode
    note,          ///< `text`
    deviation,     ///< `code`, and `text` which may be empty
    delay,  ///< a deviation that delayed the session; the current presentation is treated as paused
    abort,  ///< `text` is the reason; the session is stopped and closed
    leave,  ///< the program must end for the reason in `text`; the session stays open and can be
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
  std::string code;  ///< code of the deviation if the item is skipped, for instance "no-curtain"
  std::string text;
};
enum class Tick { done, skipped };

/// All functions are called on the session's thread, and none waits for the person.
class Experimenter {
 public:
  virtual ~Experimenter() = default;

  /// Shows the session's state; called at every change and several times a second.
  virtual void show(const SessionStatus& /*status*/) {}
  /// Returns the next request, each once; empty if there is none.
  [[nodiscard]] virtual std::optional<ExperimenterRequest> request() { return std::nullopt; }
  /// Asks for the day sheet before the participant sits down. Called repeatedly until there is a
  /// reply. The default replies with an empty list, so that nothing is recorded.
  /// \return the state of each item, in order
  [[nodiscard]] virtual std::optional<std::vector<Tick>> day_sheet(
      const std::vector<DaySheetItem>& /*items*/) {
    return std::vector<Tick>{};
  }
  /// Called when the answer to a presentation has been stored durably.
  /// \param trial  number of the presentation
  virtual void acknowledged(int /*trial*/) {}
};

}  // namespace touchtrial::session
