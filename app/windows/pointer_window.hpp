/// \file The plane on a screen for the device "mouse", in demonstration and pilot sessions.
#pragma once

#include "app/windows/glfw_window.hpp"
#include "core/vec.hpp"
#include "device/mouse/pointer_exchange.hpp"

#include <cstdint>
#include <string>

namespace touchtrial::app {

/// Shows a blank plane at its true size, and the stylus on it. Only the stylus' position depends on
/// a texture. A plane that is larger than the screen is shown smaller, and a line below it says so.
/// Belongs to the main thread, like GlfwWindow.
class PointerWindow {
 public:
  /// \param exchange  the exchange of a MouseDevice; must outlive this
  /// \param plane_mm  sides of the plane, > 0
  /// \throws DeviceError as GlfwWindow
  PointerWindow(device::PointerExchange& exchange, Vec2 plane_mm);
  /// Tells the device that the window has closed.
  ~PointerWindow();
  PointerWindow(const PointerWindow&) = delete;
  PointerWindow& operator=(const PointerWindow&) = delete;

  /// Publishes the pointer and draws one picture, for which it waits until it is due. Call it again
  /// without delay.
  void draw_frame();

  /// Whether the person has pressed the space bar.
  [[nodiscard]] bool stop_asked() const noexcept { return stop_asked_; }
  [[nodiscard]] bool close_asked() const { return window_.close_asked(); }
  [[nodiscard]] GlfwWindow& window() noexcept { return window_; }
  /// The plane's top-left corner on the screen, window units.
  [[nodiscard]] Vec2 plane_corner() const noexcept { return corner_; }
  /// Millimetres on the plane for one window unit.
  [[nodiscard]] double mm_per_unit() const noexcept { return mm_per_unit_; }

 private:
  void publish(const WindowPointer& pointer);
  void place_plane();
  void draw_pointer();
  [[nodiscard]] std::string scale_in_words() const;

  device::PointerExchange& exchange_;
  Vec2 plane_mm_;
  GlfwWindow window_;
  double mm_per_unit_ = 1.0;  ///< of the plane as drawn
  Vec2 corner_;               ///< the plane's, window units
  WindowPointer pointer_;
  std::uint64_t shown_ = 0;  ///< sequence number of the stylus that was shown last
  int frames_without_news_ = 0;
  bool stop_asked_ = false;
};

}  // namespace touchtrial::app
