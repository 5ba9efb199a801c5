/// \file The experimenter's window. Its owner has started GLFW.
#pragma once

#include "app/windows/experimenter/experimenter_desk.hpp"
#include "engine/pictures/colour_image.hpp"

#include <chrono>
#include <functional>
#include <memory>
#include <optional>

namespace touchtrial::app {

/// A part of the screen, in screen coordinates.
struct ScreenArea {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

struct ConsoleWindowOptions {
  /// Number of the monitor, from 1 as the system counts; if not set, `area` applies.
  std::optional<int> monitor;
  /// The window is placed in its corner and limited to its size; if not set, the system chooses
  /// the position.
  std::optional<ScreenArea> area;
  /// Whether a plane is on, so that all keys go to the participant's window. Called on both
  /// threads.
  std::function<bool()> keyboard_is_participants;
  /// Receives the arguments of GLFW's key callback for every key that is not text of this window.
  /// Called on the main thread.
  std::function<void(int key, int action, int modifiers)> key;
  /// Makes the drawing thread check whether this window needs a new frame. Called on any thread.
  std::function<void()> wake;
};

/// Does not take the focus when it opens, and the window manager cannot close it: only the
/// participant's window or Abort ends a session.
class ConsoleWindow {
 public:
  /// Call it on the main thread while GLFW is running.
  /// \param desk  must outlive this
  /// \throws DeviceError with the remedy if the monitor or OpenGL 3.2 is missing
  ConsoleWindow(ExperimenterDesk& desk, const ConsoleWindowOptions& options);
  /// Runs on the main thread, after drawing has ended.
  ~ConsoleWindow();
  ConsoleWindow(const ConsoleWindow&) = delete;
  ConsoleWindow& operator=(const ConsoleWindow&) = delete;

  /// Whether this window has the keyboard focus. Runs on the main thread.
  [[nodiscard]] bool has_focus() const;

  /// \name Drawing thread. These functions change the current OpenGL context.
  ///@{
  void begin_drawing();
  [[nodiscard]] bool needs_frame() const;
  void draw();
  void end_drawing();
  ///@}

  /// Waits for the next picture. May be called from any thread except the drawing thread.
  /// \return nothing after the timeout
  [[nodiscard]] std::optional<engine::ColourImage> picture(std::chrono::milliseconds timeout);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace touchtrial::app
