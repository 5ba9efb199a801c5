/// \file Signals that ask the program to end, between explorations; during one StopOnSignals sees
/// to them first.
#pragma once

#include <string>

namespace touchtrial::app {

/// While this lives, SIGINT, SIGTERM and SIGHUP are remembered instead of ending the program. One
/// at a time.
class EndingSignals {
 public:
  EndingSignals();
  /// The earlier handlers are back.
  ~EndingSignals();
  EndingSignals(const EndingSignals&) = delete;
  EndingSignals& operator=(const EndingSignals&) = delete;

  /// The number of the signal that came, during explorations too; 0: none. Any thread.
  [[nodiscard]] static int which() noexcept;
  /// "stopped by SIGTERM"; empty: none came.
  [[nodiscard]] static std::string message();
};

}  // namespace touchtrial::app
