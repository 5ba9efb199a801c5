/// \file Leaves libpng and libjpeg from their error handlers, which must not return.
#pragma once

#include <array>
#include <csetjmp>
#include <cstdio>

namespace touchtrial::engine {

/// The jump target of an error handler, and its message.
struct Escape {
  std::jmp_buf back;
  std::array<char, 200> complaint{};

  [[noreturn]] void leave(const char* what) noexcept {
    std::snprintf(complaint.data(), complaint.size(), "%s", what);
    std::longjmp(back, 1);
  }
};

/// Runs `steps`, which an error handler may leave half-way by `escape`. The jump calls no
/// destructors: create everything that needs one outside `steps`, and capture it by reference.
/// \return whether the steps reached their end
template <typename Steps>
[[nodiscard, gnu::noinline]] bool reaches_end(Escape& escape, const Steps& steps) {
  if (setjmp(escape.back) != 0) return false;
  steps();
  return true;
}

}  // namespace touchtrial::engine
