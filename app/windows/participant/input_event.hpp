/// \file A participant's input from keyboard, mouse or gamepad, converted from GLFW's events.
#pragma once

#include "core/vec.hpp"

#include <array>
#include <chrono>
#include <functional>
#include <optional>

namespace touchtrial::app {

enum class Key {
  none,
  enter,  ///< also Enter on the keypad, and A of a gamepad
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
  digit,  ///< also a digit on the keypad
};

struct InputEvent {
  using Time = std::chrono::steady_clock::time_point;
  enum class Kind {
    key,      ///< a key is pressed
    repeat,   ///< a held key is repeated by the system
    letter,   ///< a letter is typed
    moved,    ///< the pointer has moved
    pressed,  ///< the left button is pressed
    released,
  };
  Kind kind = Kind::key;
  Time at{};  ///< time of arrival
  Key key = Key::none;
  int digit = 0;        ///< 0 to 9
  bool shift = false;   ///< held down with the key
  char32_t letter = 0;  ///< Unicode
  Vec2 position{};      ///< position of the pointer, window units from the top-left corner
};

/// Call it on the main thread.
/// \param key,action,modifiers  as GLFW's key callback receives them
/// \return an event with Key::none if the key is released or has no meaning
[[nodiscard]] InputEvent event_of_key(int key, int action, int modifiers);

/// Turns gamepad buttons into keys: the D-pad is the arrow keys, A is Enter, B is the space bar. A
/// held button repeats like a key. GLFW has no gamepad events, so a key is stamped when it is
/// polled. Belongs to the main thread.
class Gamepads {
 public:
  /// Reads all gamepads.
  /// \param on_button  called for each button that was pressed since the last poll or repeats
  void poll(const std::function<void(Key, InputEvent::Kind)>& on_button);

 private:
  static constexpr int kPads = 16;
  static constexpr int kButtons = 6;
  /// The time of the next repeat of each held button.
  std::array<std::array<std::optional<InputEvent::Time>, kButtons>, kPads> repeats_{};
};

}  // namespace touchtrial::app
