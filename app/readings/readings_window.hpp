/// \file A window with the live readings of a device: the stylus before the plane, and graphs of the
/// last five seconds. For the device "mouse", its pointer.
#pragma once

#include "app/readings/history.hpp"
#include "app/windows/glfw_window.hpp"
#include "device/haptic_device.hpp"
#include "device/mouse/pointer_exchange.hpp"
#include "device/servo/servo.hpp"

#include <string>

namespace touchtrial::app {

/// What one picture shows beside the history.
struct LiveReadings {
  device::DeviceInfo device;
  std::string phase;  ///< of the run
  device::ServoState newest;
  double rate_hz = device::kServoRateHz;  ///< requested
};

/// Belongs to the main thread, like GlfwWindow.
class ReadingsWindow {
 public:
  /// \param exchange  takes the pointer; must outlive this
  /// \throws DeviceError as GlfwWindow
  explicit ReadingsWindow(device::PointerExchange& exchange);
  /// Tells a MouseDevice that the window has closed.
  ~ReadingsWindow();
  ReadingsWindow(const ReadingsWindow&) = delete;
  ReadingsWindow& operator=(const ReadingsWindow&) = delete;

  /// Publishes the pointer and draws one picture, for which it waits until it is due. Call it again
  /// without delay.
  void draw(const LiveReadings& now, const ReadingsHistory& history);

  /// Whether the person has pressed the space bar, or closed the window.
  [[nodiscard]] bool stop_asked() const { return stop_asked_ || window_.close_asked(); }
  [[nodiscard]] GlfwWindow& window() noexcept { return window_; }
  /// Window units of a place on the plane of a mouse, mm.
  [[nodiscard]] Vec2 at(Vec2 plane_mm) const { return origin_ + (1.0 / mm_per_unit_) * plane_mm; }

 private:
  void draw_plane(const LiveReadings& now, Vec2 size);
  void draw_facts(const LiveReadings& now) const;

  device::PointerExchange& exchange_;
  GlfwWindow window_;
  Vec2 origin_;               ///< of the plane, window units
  double mm_per_unit_ = 1.0;  ///< of the plane as drawn
  bool stop_asked_ = false;
};

}  // namespace touchtrial::app
