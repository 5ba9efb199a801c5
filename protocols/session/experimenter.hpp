/// \file Whoever runs a session: sees how it stands, and never what is presented.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::session {

/// What the experimenter is shown. Nothing in it depends on a stimulus or on an outcome.
struct SessionStatus {
  std::string participant;
  std::string
      stage;      ///< "day sheet", "instructions", "practice", "ready", "exploring", "answering"..
  int trial = 0;  ///< presentations begun, the current one included; 0: none yet
  int of = 0;     ///< that there will be, repeated ones included
  bool practice = false;
  std::chrono::nanoseconds elapsed{};  ///< since the session's opening
  std::string device;                  ///< its name, and what it needs
  /// Of the last exploration in real time.
  double rate_hz = 0.0;
  double lateness_p99_us = 0.0;
  std::int64_t overruns = 0;
  int interruptions = 0;
};

/// What the experimenter asks for, at any time.
struct ExperimenterRequest {
  enum class Kind {
    pause,         ///< `text` is the reason
    resume,        ///< ends a pause
    comfort_stop,  ///< zero force within 100 ms; `text` is the reason, which must not tell of the
                   ///< texture: the trial is marked as interrupted
    note,          ///< `text`
    deviation,     ///< `code`, and `text` which may be empty
    abort,         ///< `text` is the reason; the session is stopped and closed
    leave,         ///< the program is to end, `text` says why: the session stays open and can be
                   ///< taken up again
  };
  Kind kind{};
  std::string text;
  std::string code;
};

/// An item of the day sheet, and what became of it.
struct DaySheetItem {
  std::string code;  ///< of the deviation that skipping it is; for instance "no-curtain"
  std::string text;
};
enum class Tick { done, skipped };

/// Called on the session's thread. None of the functions waits for the person.
class Experimenter {
 public:
  virtual ~Experimenter() = default;

  /// How the session stands now; called at every change, and several times a second meanwhile.
  virtual void show(const SessionStatus& /*status*/) {}
  /// The next request that was made, each once.
  [[nodiscard]] virtual std::optional<ExperimenterRequest> request() { return std::nullopt; }
  /// The day sheet before the participant sits down; called over and over until there is a reply,
  /// in the items' order. The default: nobody to ask, nothing recorded.
  [[nodiscard]] virtual std::optional<std::vector<Tick>> day_sheet(
      const std::vector<DaySheetItem>& /*items*/) {
    return std::vector<Tick>{};
  }
  /// The response of a presentation is durable. \param trial  its number
  virtual void acknowledged(int /*trial*/) {}
};

}  // namespace touchtrial::session
