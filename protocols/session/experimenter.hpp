/// \file The experimenter, who runs a session: sees its state, and never what is presented.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::session {

/// Beside what participants are told.
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
  /// As the participant's window counts: presentations begun, with the current one and with the one
  /// that is announced; in practice, those of the round. 0: none yet.
  int trial = 0;
  int of = 0;  ///< presentations in all, with repetitions; in practice, of the round
  bool practice = false;
  bool participant_stopped = false;    ///< the participant's comfort stop is not settled yet
  bool needs_consent = false;          ///< no force until the experimenter consents
  std::chrono::nanoseconds elapsed{};  ///< since the session's opening
  std::string device{};                ///< its name, and what it needs
  std::string alert{};                 ///< what somebody must do now; empty: nothing
  /// While a plane is on in real time, and the hand at it.
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
    delay,         ///< a deviation that kept the session waiting: a presentation that is under way
                   ///< counts as after a pause
    abort,         ///< `text` is the reason; the session is stopped and closed
    leave,         ///< the program has to end, and `text` says why; the session stays open and can
                   ///< be taken up again
  };
  Kind kind{};
  std::string text;
  std::string code;
};

/// Code of the deviation whose text says why there was a comfort stop.
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
  /// \return what became of the items, in their order
  [[nodiscard]] virtual std::optional<std::vector<Tick>> day_sheet(
      const std::vector<DaySheetItem>& /*items*/) {
    return std::vector<Tick>{};
  }
  /// The response of a presentation is durable.
  /// \param trial  its number
  virtual void acknowledged(int /*trial*/) {}
};

}  // namespace touchtrial::session
