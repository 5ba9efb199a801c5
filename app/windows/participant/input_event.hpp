/// \file Input events of a participant by keyboard, mouse or gamepad, with times; converted from
///   GLFW's.
#pragma once

#include "core/vec.hpp"

#include <array>
#include <chrono>
#include <functional>
#include <optional>

namespace touchtrial::app {

enum class Key {
  none,
  enter,  ///< also the keypad's, and A of a gamepad
  space,
  left,
  right,
  up,
  down,
  tab,
  back_tab,
  backspace,
  remove,
  home,
  end,
  digit,  ///< also the keypad's
};

struct InputEvent {
  using Time = std::chrono::steady_clock::time_point;
  enum class Kind {
    key,     ///< went down
    repeat,  ///< held down: the system repeats it
    letter,  ///< typed
    moved,
    pressed,  ///< left button
    released,
  };
  Kind kind = Kind::key;
  Time at{};  ///< time of arrival
  Key key = Key::none;
  int digit = 0;        ///< 0 to 9
  bool shift = false;   ///< held down with the key
  char32_t letter = 0;  ///< Unicode
  Vec2 position{};      ///< of the pointer, window units from the top-left corner
};

/// Call it on the main thread.
/// \param key,action,modifiers  as GLFW's key callback receives them
/// \return an event of Key::none for a key without meaning or a key that is released
[[nodiscard]] InputEvent event_of_key(int key, int action, int modifiers);

/// Turns buttons of gamepads into keys: the cross moves, A is Enter, B is the space bar. A held
/// button repeats, like a key. GLFW has no events for gamepads, so the time of a key is that of the
/// poll. Belongs to the main thread.
class Gamepads {
 public:
  /// Reads all gamepads.
  /// \param on_button  called for each button that was pressed since the last poll or repeats
  void poll(const std::function<void(Key, InputEvent::Kind)>& on_button);

 private:
  static constexpr int kPads = 16;
  static constexpr int kButtons = 6;
  /// When held buttons repeat next.
  std::array<std::array<std::optional<InputEvent::Time>, kButtons>, kPads> repeats_{};
};

}  // namespace touchtrial::app
