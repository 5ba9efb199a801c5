/// \file GLFW's keys and gamepads as the window's input events. Main thread.
#pragma once

#include "app/participant/input_event.hpp"

#include <array>
#include <functional>

namespace touchtrial::app {

/// \param key,action,modifiers  as GLFW's key callback has them
/// \return an event of Key::none for keys that mean nothing, and for a key that comes up
[[nodiscard]] InputEvent event_of_key(int key, int action, int modifiers);

/// Turns what gamepads hold into keys that go down: the cross moves, A is Enter, B is the space
/// bar. GLFW has no events of them, so they are as exact as they are looked at often.
class Gamepads {
 public:
  /// Looks at all of them. \param tell  called for each button that went down
  void poll(const std::function<void(Key)>& tell);
  [[nodiscard]] bool any() const noexcept { return any_; }

 private:
  static constexpr int kPads = 16;
  static constexpr int kButtons = 6;
  std::array<std::array<bool, kButtons>, kPads> held_{};
  bool any_ = false;
};

}  // namespace touchtrial::app
