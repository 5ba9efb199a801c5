/// \file Jumps out of the error handlers of libpng and libjpeg, which must not return.
#pragma once

#include <array>
#include <csetjmp>
#include <cstdio>

namespace touchtrial::engine {

/// The jump target of an error handler, and its message.
struct Escape {
  std::jmp_buf jump_target;
  std::array<char, 200> message{};

  [[noreturn]] void leave(const char* reason) noexcept {
    std::snprintf(message.data(), message.size(), "%s", reason);
    std::longjmp(jump_target, 1);
  }
};

/// Runs `steps`, which an error handler may leave through `escape`. The jump calls no destructors:
/// create objects that need one outside `steps`, and capture them by reference.
/// \return whether the steps completed
template <typename Steps>
[[nodiscard, gnu::noinline]] bool run_guarded(Escape& escape, const Steps& steps) {
  if (setjmp(escape.jump_target) != 0) return false;
  steps();
  return true;
}

}  // namespace touchtrial::engine
