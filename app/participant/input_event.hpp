/// \file What a participant did with keyboard, mouse or gamepad, and when.
#pragma once

#include "core/vec.hpp"

#include <chrono>

namespace touchtrial::app {

enum class Key {
  none,
  enter,  ///< keypad's too, and a gamepad's A
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
  digit,  ///< keypad's too
};

struct InputEvent {
  using Time = std::chrono::steady_clock::time_point;
  enum class Kind {
    key,     ///< went down
    repeat,  ///< is held, as the system repeats it
    letter,  ///< typed
    moved,
    pressed,  ///< left button
    released,
  };
  Kind kind = Kind::key;
  Time at{};  ///< when it arrived
  Key key = Key::none;
  int digit = 0;        ///< 0 to 9
  char32_t letter = 0;  ///< Unicode
  Vec2 position;        ///< of the pointer, window units from the top-left corner
};

}  // namespace touchtrial::app
