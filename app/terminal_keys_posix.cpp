#include "app/terminal_keys.hpp"

#include <poll.h>
#include <termios.h>
#include <unistd.h>

namespace touchtrial {

struct TerminalKeys::Saved {
  termios terminal{};
};

TerminalKeys::TerminalKeys() {
  // In the background a change of the terminal would stop the program.
  if (::isatty(STDIN_FILENO) == 0 || ::tcgetpgrp(STDIN_FILENO) != ::getpgrp()) return;
  Saved saved;
  if (::tcgetattr(STDIN_FILENO, &saved.terminal) != 0) return;
  termios keys = saved.terminal;
  keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  keys.c_cc[VMIN] = 0;
  keys.c_cc[VTIME] = 0;
  if (::tcsetattr(STDIN_FILENO, TCSANOW, &keys) != 0) return;
  saved_ = std::make_unique<Saved>(saved);
}

TerminalKeys::~TerminalKeys() {
  if (saved_) ::tcsetattr(STDIN_FILENO, TCSANOW, &saved_->terminal);
}

std::optional<char> TerminalKeys::next() {
  if (ended_) return std::nullopt;
  pollfd input{STDIN_FILENO, POLLIN, 0};
  if (::poll(&input, 1, 0) <= 0) return std::nullopt;
  char key = 0;
  if (::read(STDIN_FILENO, &key, 1) == 1) return key;
  ended_ = true;
  return std::nullopt;
}

}  // namespace touchtrial
