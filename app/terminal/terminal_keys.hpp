/// \file Unbuffered keys of the terminal. Each platform has its own source file.
#pragma once

#include <optional>

namespace touchtrial::app {

/// Reads standard input and never waits. While this object exists, keys on the program's terminal
/// are delivered one by one without echo. Ctrl-C remains a signal; Ctrl-Z does not, because a
/// suspended program cannot release a force. A pipe or file yields its characters up to its end.
/// One object at a time.
class TerminalKeys {
 public:
  TerminalKeys();
  /// Restores the terminal.
  ~TerminalKeys();
  /// Restores the terminal before the program is killed. Safe in a signal handler, and without an
  /// object.
  static void restore() noexcept;
  TerminalKeys(const TerminalKeys&) = delete;
  TerminalKeys& operator=(const TerminalKeys&) = delete;

  /// The next key, if one was pressed.
  [[nodiscard]] std::optional<char> next();

 private:
  bool is_at_end_ = false;
};

}  // namespace touchtrial::app
