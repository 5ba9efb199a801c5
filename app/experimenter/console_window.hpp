/// \file The experimenter's window. GLFW is somebody else's: who makes this has started it.
#pragma once

#include "app/experimenter/console_experimenter.hpp"
#include "engine/pictures/colour_image.hpp"

#include <chrono>
#include <functional>
#include <memory>
#include <optional>

namespace touchtrial::app {

struct ConsoleWindowOptions {
  /// From 1 as the system counts them; none: wherever the system puts a window.
  std::optional<int> monitor;
  /// The participant is under force: every key is the participant's. Asked on both threads.
  std::function<bool()> keyboard_is_participants;
  /// Takes, on the main thread, what GLFW's key callback has of a key that is not written here.
  std::function<void(int key, int action, int modifiers)> key;
  /// Makes the drawing thread look whether this wants a picture. Any thread.
  std::function<void()> stir;
};

/// Takes no focus when it comes up, and is not closed by its window manager: a session is ended
/// by the participant's window or by Abort.
class ConsoleWindow {
 public:
  /// Main thread, GLFW running. \param console  must outlive this
  /// \throws DeviceError with the remedy if there is no such monitor, or no OpenGL 3.2
  ConsoleWindow(ConsoleExperimenter& console, const ConsoleWindowOptions& options);
  /// Main thread, when nothing draws any more.
  ~ConsoleWindow();
  ConsoleWindow(const ConsoleWindow&) = delete;
  ConsoleWindow& operator=(const ConsoleWindow&) = delete;

  /// \name Drawing thread. The OpenGL context that was current is not afterwards.
  ///@{
  void begin_drawing();
  [[nodiscard]] bool wants_picture() const;
  void draw();
  void end_drawing();
  ///@}

  /// Waits for the next picture; any other thread. \return nothing if none comes
  [[nodiscard]] std::optional<engine::ColourImage> picture(std::chrono::milliseconds longest);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace touchtrial::app
