/// \file Keys as they are pressed, without waiting for the end of a line. One source file a
/// platform.
#pragma once

#include <memory>
#include <optional>

namespace touchtrial {

/// Reads standard input without ever waiting. On a terminal that the program has to itself, keys
/// come one by one and are not shown, until this is destroyed; Ctrl-C stays a signal. From a pipe
/// or file come its characters; its end is no key.
class TerminalKeys {
 public:
  TerminalKeys();
  /// The terminal is as it was.
  ~TerminalKeys();
  TerminalKeys(const TerminalKeys&) = delete;
  TerminalKeys& operator=(const TerminalKeys&) = delete;

  /// The next key that was pressed, if there is one.
  [[nodiscard]] std::optional<char> next();

 private:
  struct Saved;
  std::unique_ptr<Saved> saved_;  ///< the terminal as it was; null if there is none
  bool ended_ = false;
};

}  // namespace touchtrial
