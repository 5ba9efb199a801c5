/// \file The monitor's window: how it looks, and what the person asks for in it.
#pragma once

#include "app/monitor/monitor_history.hpp"
#include "app/monitor/monitor_words.hpp"
#include "app/windows/glfw_window.hpp"
#include "device/haptic_device.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

/// Everything that is drawn.
struct MonitorPicture {
  device::DeviceInfo device;
  StateLine state;
  device::ServoState newest;
  std::vector<std::string> notes;  ///< what the servo got of the system, and the last run
  const MonitorHistory* history = nullptr;
  double rate_hz = 1000.0;  ///< that was asked for
  bool running = false;
  bool wall_on = false;
};

/// What the person did since the last picture.
struct MonitorRequests {
  bool stop = false;
  bool resume = false;
  std::optional<bool> wall;
  /// Where the pointer is on the view's plane, mm, and whether it presses; for the mouse.
  Vec2 pointer_mm;
  bool pressed = false;
};

/// Draws one picture between begin_frame and end_frame of the window. Main thread.
[[nodiscard]] MonitorRequests draw_monitor(GlfwWindow& window, const MonitorPicture& picture);

}  // namespace touchtrial::app
