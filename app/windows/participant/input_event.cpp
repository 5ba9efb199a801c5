#include "app/windows/participant/input_event.hpp"

#include <algorithm>
#include <utility>

#include <GLFW/glfw3.h>

namespace touchtrial::app {
namespace {

constexpr std::array<std::pair<int, Key>, 11> kKeys = {{
    {GLFW_KEY_ENTER, Key::enter},
    {GLFW_KEY_KP_ENTER, Key::enter},
    {GLFW_KEY_SPACE, Key::space},
    {GLFW_KEY_LEFT, Key::left},
    {GLFW_KEY_RIGHT, Key::right},
    {GLFW_KEY_UP, Key::up},
    {GLFW_KEY_DOWN, Key::down},
    {GLFW_KEY_BACKSPACE, Key::backspace},
    {GLFW_KEY_DELETE, Key::remove},
    {GLFW_KEY_HOME, Key::home},
    {GLFW_KEY_END, Key::end},
}};

Key key_of(int key, bool shift) {
  if (key == GLFW_KEY_TAB) return shift ? Key::back_tab : Key::tab;
  const auto entry = std::ranges::find(kKeys, key, &std::pair<int, Key>::first);
  return entry == kKeys.end() ? Key::none : entry->second;
}

constexpr std::array<std::pair<int, Key>, 6> kPadKeys = {{
    {GLFW_GAMEPAD_BUTTON_DPAD_LEFT, Key::left},
    {GLFW_GAMEPAD_BUTTON_DPAD_RIGHT, Key::right},
    {GLFW_GAMEPAD_BUTTON_DPAD_UP, Key::up},
    {GLFW_GAMEPAD_BUTTON_DPAD_DOWN, Key::down},
    {GLFW_GAMEPAD_BUTTON_A, Key::enter},
    {GLFW_GAMEPAD_BUTTON_B, Key::space},
}};

constexpr std::chrono::milliseconds kRepeatDelay{400};
constexpr std::chrono::milliseconds kRepeatInterval{40};

}  // namespace

InputEvent event_of_key(int key, int action, int modifiers) {
  InputEvent event;
  event.at = std::chrono::steady_clock::now();
  if (action == GLFW_RELEASE) return event;
  event.kind = action == GLFW_REPEAT ? InputEvent::Kind::repeat : InputEvent::Kind::key;
  event.shift = (modifiers & GLFW_MOD_SHIFT) != 0;
  event.key = key_of(key, event.shift);
  if (key >= GLFW_KEY_0 && key <= GLFW_KEY_9) {
    event.key = Key::digit;
    event.digit = key - GLFW_KEY_0;
  } else if (key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_9) {
    event.key = Key::digit;
    event.digit = key - GLFW_KEY_KP_0;
  }
  return event;
}

void Gamepads::poll(const std::function<void(Key, InputEvent::Kind)>& on_button) {
  const InputEvent::Time now = std::chrono::steady_clock::now();
  for (int pad = 0; pad < kPads; ++pad) {
    GLFWgamepadstate state;
    if (glfwJoystickIsGamepad(pad) == GLFW_FALSE ||
        glfwGetGamepadState(pad, &state) == GLFW_FALSE) {
      repeats_[pad].fill(std::nullopt);
      continue;
    }
    for (std::size_t i = 0; i < kPadKeys.size(); ++i) {
      std::optional<InputEvent::Time>& next_repeat = repeats_[pad][i];
      if (state.buttons[kPadKeys[i].first] != GLFW_PRESS) {
        next_repeat.reset();
      } else if (!next_repeat) {
        on_button(kPadKeys[i].second, InputEvent::Kind::key);
        next_repeat = now + kRepeatDelay;
      } else if (now >= *next_repeat) {
        on_button(kPadKeys[i].second, InputEvent::Kind::repeat);
        next_repeat = now + kRepeatInterval;
      }
    }
  }
}

}  // namespace touchtrial::app
