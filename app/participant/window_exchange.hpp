/// \file The exchange between the session's thread, the main thread and the drawing thread of a
/// participant's window.
#pragma once

#include "app/participant/screen.hpp"
#include "engine/pictures/colour_image.hpp"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace touchtrial::app {

/// The window as the main thread knows it.
struct WindowSurface {
  Vec2 size;         ///< window units
  int width_px = 0;  ///< of the picture
  int height_px = 0;
  Glass glass;
  double refresh_hz = 60.0;
};

/// All functions may be called from any thread. Only those that say so wait.
class WindowExchange {
 public:
  /// The next work of the drawing thread.
  struct Work {
    std::shared_ptr<Screen> screen;
    WindowSurface surface;
    std::vector<InputEvent> events;
    bool picture_wanted = false;
    bool ending = false;
    bool is_new = true;  ///< something came since the last call
  };

  /// \name Session's thread
  ///@{
  void show(std::shared_ptr<Screen> screen);
  /// Waits for the screen's reply.
  /// \return the reply, once; nothing if none comes in time
  [[nodiscard]] std::optional<session::StepReply> reply(const Screen& of,
                                                        std::chrono::milliseconds longest);
  ///@}

  /// \name Main thread
  ///@{
  void push(const InputEvent& event);
  void set_surface(const WindowSurface& surface);
  void redraw();
  void end();
  ///@}

  /// \name Drawing thread
  ///@{
  /// Waits until there is something new, or until `longest` has passed.
  [[nodiscard]] Work wait_for_work(std::chrono::milliseconds longest);
  /// \param events_left  whether the screen has yet to take events
  void shown(const std::shared_ptr<Screen>& screen, bool events_left);
  void replied(const std::shared_ptr<Screen>& screen, const session::StepReply& reply);
  void keep(engine::ColourImage picture);
  void failed(std::exception_ptr failure);
  ///@}

  /// Wakes the drawing thread for something else that it draws.
  void stir();
  [[nodiscard]] WindowSurface surface() const;
  /// Waits until the newest screen is visible and has taken all events.
  /// \return false if that does not happen in time
  [[nodiscard]] bool wait_until_shown(std::chrono::milliseconds longest);
  /// Waits for the next picture.
  /// \return nothing if none comes in time
  [[nodiscard]] std::optional<engine::ColourImage> picture(std::chrono::milliseconds longest);
  /// \throws what drawing threw
  void check() const;

 private:
  mutable std::mutex mutex_;
  std::condition_variable for_drawing_;
  std::condition_variable for_others_;
  std::shared_ptr<Screen> screen_;
  std::shared_ptr<Screen> shown_;
  std::shared_ptr<Screen> replied_by_;
  std::optional<session::StepReply> reply_;
  WindowSurface surface_;
  std::vector<InputEvent> events_;
  std::optional<engine::ColourImage> picture_;
  std::exception_ptr failure_;
  bool picture_wanted_ = false;
  bool dirty_ = true;
  bool stirred_ = false;
  bool settled_ = false;  ///< the last picture shows the effect of all events
  bool ending_ = false;
};

}  // namespace touchtrial::app
