#include "app/terminal/terminal_keys.hpp"

#include <atomic>

#include <poll.h>
#include <termios.h>
#include <unistd.h>

namespace touchtrial::app {

namespace {

/// Read by signal handlers: written before `is_changed` is set, and read after it.
termios original_terminal;
std::atomic<bool> is_changed{false};
static_assert(std::atomic<bool>::is_always_lock_free);

}  // namespace

TerminalKeys::TerminalKeys() {
  // A background program would be stopped if it changed the terminal.
  if (::isatty(STDIN_FILENO) == 0 || ::tcgetpgrp(STDIN_FILENO) != ::getpgrp()) return;
  if (::tcgetattr(STDIN_FILENO, &original_terminal) != 0) return;
  termios keys = original_terminal;
  keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  keys.c_cc[VMIN] = 0;
  keys.c_cc[VTIME] = 0;
  keys.c_cc[VSUSP] = _POSIX_VDISABLE;
  // Set before the change: a signal in between restores the unchanged terminal.
  is_changed.store(true);
  if (::tcsetattr(STDIN_FILENO, TCSANOW, &keys) != 0) is_changed.store(false);
}

TerminalKeys::~TerminalKeys() {
  restore();
}

void TerminalKeys::restore() noexcept {
  if (is_changed.exchange(false)) ::tcsetattr(STDIN_FILENO, TCSANOW, &original_terminal);
}

std::optional<char> TerminalKeys::next() {
  if (is_at_end_) return std::nullopt;
  pollfd input{STDIN_FILENO, POLLIN, 0};
  if (::poll(&input, 1, 0) <= 0) return std::nullopt;
  char key = 0;
  if (::read(STDIN_FILENO, &key, 1) == 1) return key;
  is_at_end_ = true;
  return std::nullopt;
}

}  // namespace touchtrial::app
