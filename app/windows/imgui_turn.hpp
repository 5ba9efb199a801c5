/// \file Dear ImGui keeps its context in one variable of the program: where two threads draw, they
/// take turns.
#pragma once

#include <mutex>

namespace touchtrial::app {

/// Held from setting the context to the end of rendering, not while a screen is waited for.
inline std::mutex& imgui_turn() {
  static std::mutex turn;
  return turn;
}

}  // namespace touchtrial::app
