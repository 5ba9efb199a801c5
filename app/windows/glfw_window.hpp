/// \file A window with an OpenGL picture and Dear ImGui in it. Neither library shows here.
#pragma once

#include "core/vec.hpp"
#include "engine/pictures/colour_image.hpp"

#include <functional>
#include <memory>
#include <string>

namespace touchtrial::app {

struct WindowOptions {
  std::string title;
  int width_px = 1280;  ///< >= 1, before scaling for the screen's density; cut to the screen
  int height_px = 800;
  bool hide_cursor = false;  ///< something else is drawn in the pointer's place
};

/// Where the pointer is and whether its left button is held, in window units.
struct WindowPointer {
  Vec2 position;
  bool pressed = false;
};

/// One window at a time. All functions belong to the program's main thread, which windowing systems
/// ask for; whatever must not wait for a screen (a servo) runs on other threads.
///
/// Window units are what the windowing system counts in; they are pixels but on screens where the
/// system hides their density.
class GlfwWindow {
 public:
  /// \throws DeviceError with the remedy if there is no display, or no OpenGL 3
  explicit GlfwWindow(const WindowOptions& options);
  ~GlfwWindow();
  GlfwWindow(const GlfwWindow&) = delete;
  GlfwWindow& operator=(const GlfwWindow&) = delete;

  /// Called from `begin_frame` for every motion and press as it comes, and once a frame.
  void on_pointer(std::function<void(const WindowPointer&)> listener);

  /// Called from `begin_frame` whenever the space bar goes down, however short: every window that
  /// may stop a force stops it by this key.
  void on_stop_key(std::function<void()> listener);

  /// Takes events until the next picture is due on the screen, then begins it: what ImGui is told
  /// between this and `end_frame` is shown.
  void begin_frame();
  void end_frame();

  /// The person has closed the window.
  [[nodiscard]] bool close_asked() const;
  /// Window units.
  [[nodiscard]] Vec2 size() const;
  /// Millimetres of the screen for one window unit, as the monitor states its size.
  [[nodiscard]] double mm_per_unit() const;
  /// Whether the monitor stated a size that can be true; else 96 units to the inch are assumed.
  [[nodiscard]] bool scale_is_known() const;
  /// Sizes on screen are to be multiplied by this, 1 at 96 units to the inch.
  [[nodiscard]] float density() const;
  /// The picture that was shown last. \throws std::logic_error before the first
  [[nodiscard]] const engine::ColourImage& picture();
  /// Pictures are only kept once this is asked for.
  void keep_pictures();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace touchtrial::app
