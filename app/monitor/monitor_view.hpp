/// \file The contents of the monitor's window, and the person's requests.
#pragma once

#include "app/monitor/monitor_run.hpp"
#include "app/windows/glfw_window.hpp"
#include "device/haptic_device.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

enum class StateTone { running, waiting, stopped, fault };

struct StateLine {
  StateTone tone = StateTone::waiting;
  std::string text;  ///< one line
};

/// The state that a StateLine describes.
struct MonitoredState {
  bool ready = true;  ///< of the newest sample
  device::DeviceReadiness readiness = device::DeviceReadiness::ready;
  bool wall_on = false;
  bool wall_waits = false;
  std::optional<device::ServoReport> ended = std::nullopt;  ///< nothing while the servo runs
};

[[nodiscard]] StateLine state_line(const MonitoredState& state);

/// Everything that is drawn.
struct MonitorPicture {
  device::DeviceInfo device;
  StateLine state;
  device::ServoState newest;
  std::vector<std::string> notes;  ///< about the servo's scheduling and the last run
  const MonitorHistory* history = nullptr;
  double rate_hz = 1000.0;  ///< requested
  bool running = false;
  bool wall_on = false;
  double wall_n_per_mm = TestWall::kStiffnessNPerMm;
  bool needs_reset = false;  ///< DeviceReadiness::needs_reset
};

/// The person's input since the last picture.
struct MonitorRequests {
  bool stop = false;
  bool resume = false;
  bool calibrate = false;  ///< the arm is at its reset position
  std::optional<bool> wall;
  Vec2 pointer_mm;  ///< the pointer's position on the plane, for the device "mouse"
  bool pressed = false;
};

/// Draws one picture. Call on the main thread, between begin_frame and end_frame of the window.
[[nodiscard]] MonitorRequests draw_monitor(GlfwWindow& window, const MonitorPicture& picture);

}  // namespace touchtrial::app
