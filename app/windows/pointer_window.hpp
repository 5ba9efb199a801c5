/// \file The plane on a screen, for the device "mouse": demonstration and pilot sessions.
#pragma once

#include "app/windows/glfw_window.hpp"
#include "core/vec.hpp"
#include "device/mouse/pointer_exchange.hpp"

#include <cstdint>
#include <string>

namespace touchtrial::app {

/// A blank plane at its true size, and the stylus on it. Nothing else that is drawn depends on a
/// texture. A plane larger than the screen is shown smaller, and a line below it says so.
/// Main thread, as GlfwWindow.
class PointerWindow {
 public:
  /// \param exchange  what a MouseDevice was made with; must outlive this, and is told when this
  ///   goes
  /// \param plane_mm  its sides, > 0
  /// \throws DeviceError as GlfwWindow
  PointerWindow(device::PointerExchange& exchange, Vec2 plane_mm);
  /// The device is told that the window has closed.
  ~PointerWindow();
  PointerWindow(const PointerWindow&) = delete;
  PointerWindow& operator=(const PointerWindow&) = delete;

  /// Hands the pointer on and draws one picture; waits until it is due. Call again at once.
  void draw_frame();

  /// The person has pressed the space bar since the window opened.
  [[nodiscard]] bool stop_asked() const noexcept { return stop_asked_; }
  [[nodiscard]] bool close_asked() const { return window_.close_asked(); }
  [[nodiscard]] GlfwWindow& window() noexcept { return window_; }
  /// Where the plane's top-left corner is drawn, window units.
  [[nodiscard]] Vec2 plane_corner() const noexcept { return corner_; }
  /// Millimetres of the plane for one window unit.
  [[nodiscard]] double mm_per_unit() const noexcept { return mm_per_unit_; }

 private:
  void publish(const WindowPointer& pointer);
  void place_plane();
  void draw_pointer();
  [[nodiscard]] std::string scale_in_words() const;

  device::PointerExchange& exchange_;
  Vec2 plane_mm_;
  GlfwWindow window_;
  double mm_per_unit_ = 1.0;  ///< of the plane, as drawn
  Vec2 corner_;               ///< the plane's, window units
  WindowPointer pointer_;
  std::uint64_t shown_ = 0;  ///< the stylus' last number
  int frames_without_news_ = 0;
  bool stop_asked_ = false;
};

}  // namespace touchtrial::app
