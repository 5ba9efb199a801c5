/// \file Keys as they are pressed, without waiting for the end of a line. One source file a
/// platform.
#pragma once

#include <optional>

namespace touchtrial::app {

/// Reads standard input without ever waiting. On a terminal that the program has to itself, keys
/// come one by one and are not shown, until this is destroyed; Ctrl-C stays a signal, Ctrl-Z is
/// none, because a program that sleeps cannot let go. From a pipe or file come its characters; its
/// end is no key. One at a time in a program.
class TerminalKeys {
 public:
  TerminalKeys();
  /// The terminal is as it was.
  ~TerminalKeys();
  /// The same for whoever dies before: safe in a signal handler, and when there is nothing to do.
  static void restore() noexcept;
  TerminalKeys(const TerminalKeys&) = delete;
  TerminalKeys& operator=(const TerminalKeys&) = delete;

  /// The next key that was pressed, if there is one.
  [[nodiscard]] std::optional<char> next();

 private:
  bool ended_ = false;
};

}  // namespace touchtrial::app
