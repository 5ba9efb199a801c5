#include "app/participant/glfw_input.hpp"

#include <utility>

#include <GLFW/glfw3.h>

namespace touchtrial::app {
namespace {

Key key_of(int key, bool shift) {
  switch (key) {
    case GLFW_KEY_ENTER:
    case GLFW_KEY_KP_ENTER:
      return Key::enter;
    case GLFW_KEY_SPACE:
      return Key::space;
    case GLFW_KEY_LEFT:
      return Key::left;
    case GLFW_KEY_RIGHT:
      return Key::right;
    case GLFW_KEY_UP:
      return Key::up;
    case GLFW_KEY_DOWN:
      return Key::down;
    case GLFW_KEY_TAB:
      return shift ? Key::back_tab : Key::tab;
    case GLFW_KEY_BACKSPACE:
      return Key::backspace;
    case GLFW_KEY_DELETE:
      return Key::remove;
    case GLFW_KEY_HOME:
      return Key::home;
    case GLFW_KEY_END:
      return Key::end;
    default:
      return Key::none;
  }
}

constexpr std::array<std::pair<int, Key>, 6> kPadKeys = {{
    {GLFW_GAMEPAD_BUTTON_DPAD_LEFT, Key::left},
    {GLFW_GAMEPAD_BUTTON_DPAD_RIGHT, Key::right},
    {GLFW_GAMEPAD_BUTTON_DPAD_UP, Key::up},
    {GLFW_GAMEPAD_BUTTON_DPAD_DOWN, Key::down},
    {GLFW_GAMEPAD_BUTTON_A, Key::enter},
    {GLFW_GAMEPAD_BUTTON_B, Key::space},
}};

}  // namespace

InputEvent event_of_key(int key, int action, int modifiers) {
  InputEvent event;
  event.at = std::chrono::steady_clock::now();
  if (action == GLFW_RELEASE) return event;
  event.kind = action == GLFW_REPEAT ? InputEvent::Kind::repeat : InputEvent::Kind::key;
  event.key = key_of(key, (modifiers & GLFW_MOD_SHIFT) != 0);
  if (key >= GLFW_KEY_0 && key <= GLFW_KEY_9) {
    event.key = Key::digit;
    event.digit = key - GLFW_KEY_0;
  } else if (key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_9) {
    event.key = Key::digit;
    event.digit = key - GLFW_KEY_KP_0;
  }
  return event;
}

void Gamepads::poll(const std::function<void(Key)>& tell) {
  any_ = false;
  for (int pad = 0; pad < kPads; ++pad) {
    GLFWgamepadstate state;
    if (glfwJoystickIsGamepad(pad) == GLFW_FALSE ||
        glfwGetGamepadState(pad, &state) == GLFW_FALSE) {
      held_[pad].fill(false);
      continue;
    }
    any_ = true;
    for (std::size_t i = 0; i < kPadKeys.size(); ++i) {
      const bool held = state.buttons[kPadKeys[i].first] == GLFW_PRESS;
      if (held && !held_[pad][i]) tell(kPadKeys[i].second);
      held_[pad][i] = held;
    }
  }
}

}  // namespace touchtrial::app
