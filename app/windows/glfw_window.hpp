/// \file A window in which Dear ImGui draws with OpenGL. Neither library shows here.
#pragma once

#include "core/vec.hpp"
#include "engine/pictures/colour_image.hpp"

#include <functional>
#include <memory>
#include <string>

namespace touchtrial::app {

struct WindowOptions {
  std::string title;
  int width_px = 1280;  ///< >= 1, before scaling for the screen's density; limited to the screen
  int height_px = 800;
};

/// One window at a time. All functions belong to the program's main thread, as windowing systems
/// require; work that must not wait for a screen, such as a servo, runs on other threads.
///
/// Window units are the windowing system's: pixels, except on screens whose density the system
/// hides.
class GlfwWindow {
 public:
  /// \throws DeviceError with the remedy if there is no display, or no OpenGL 3
  explicit GlfwWindow(const WindowOptions& options);
  ~GlfwWindow();
  GlfwWindow(const GlfwWindow&) = delete;
  GlfwWindow& operator=(const GlfwWindow&) = delete;

  /// Sets a function that `begin_frame` calls whenever the space bar goes down, however briefly:
  /// this key stops the force in every window.
  void on_stop_key(std::function<void()> listener);

  /// Takes events until the next picture is due, then begins it: the picture shows what ImGui draws
  /// between this call and `end_frame`.
  void begin_frame();
  void end_frame();

  /// Whether the person has closed the window.
  [[nodiscard]] bool close_asked() const;
  /// Window units.
  [[nodiscard]] Vec2 size() const;
  /// Millimetres on the screen for one window unit, as the monitor states its size.
  [[nodiscard]] double mm_per_unit() const;
  /// Whether the monitor states a size that can be true; else 96 units per inch are assumed.
  [[nodiscard]] bool scale_is_known() const;
  /// The factor for all sizes on the screen, 1 at 96 units per inch.
  [[nodiscard]] float density() const;
  /// The picture that was shown last.
  /// \throws std::logic_error if none was kept
  [[nodiscard]] const engine::ColourImage& picture();
  /// From now on, keeps a copy of each picture.
  void keep_pictures();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace touchtrial::app
