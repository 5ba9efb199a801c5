/// \file The drawing thread of a participant's window, its frames, and its exchange with the
///   session's thread and the main thread.
#pragma once

#include "app/windows/participant/canvas.hpp"
#include "app/windows/participant/screen.hpp"
#include "core/plane.hpp"
#include "engine/pictures/colour_image.hpp"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

struct GLFWwindow;

namespace touchtrial::app {

/// The appearance of screens.
struct ScreenLook {
  double text_scale = 1.0;
  bool high_contrast = false;
  std::set<char32_t> letters;  ///< in the fonts from the first frame on
};

/// The window's state, set by the main thread.
struct WindowSurface {
  Vec2 size;         ///< window units
  int width_px = 0;  ///< of the picture
  int height_px = 0;
  Glass glass;
  double refresh_hz = 60.0;
};

/// All functions are thread-safe. Only those documented so wait.
class WindowExchange {
 public:
  /// The next work of the drawing thread.
  struct Work {
    std::shared_ptr<Screen> screen;
    WindowSurface surface;
    std::vector<InputEvent> events;
    bool picture_wanted = false;
    bool ending = false;
    bool is_new = true;  ///< there was input since the last call
  };

  /// \name Session's thread
  ///@{
  void show(std::shared_ptr<Screen> screen);
  /// Waits for the screen's reply.
  /// \return the reply, once; nothing if none comes in time
  [[nodiscard]] std::optional<session::StepReply> reply(const Screen& of,
                                                        std::chrono::milliseconds timeout);
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
  /// Waits until there is something new, or until `timeout` has passed.
  [[nodiscard]] Work wait_for_work(std::chrono::milliseconds timeout);
  /// \param events_left  whether the screen has yet to take events
  void shown(const std::shared_ptr<Screen>& screen, bool events_left);
  void replied(const std::shared_ptr<Screen>& screen, const session::StepReply& reply);
  void keep(engine::ColourImage picture);
  void failed(std::exception_ptr failure);
  ///@}

  /// Wakes the drawing thread for something else that it draws.
  void wake();
  [[nodiscard]] WindowSurface surface() const;
  /// Waits until the newest screen is visible and has taken all events.
  /// \return false if that does not happen in time
  [[nodiscard]] bool wait_until_shown(std::chrono::milliseconds timeout);
  /// Waits for the next picture.
  /// \return nothing if none comes in time
  [[nodiscard]] std::optional<engine::ColourImage> picture(std::chrono::milliseconds timeout);
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
  bool is_woken_ = false;
  bool settled_ = false;  ///< the last picture shows the effect of all events
  bool ending_ = false;
};

class ConsoleWindow;

/// Pictures as OpenGL textures, each resized to the size at which it is shown.
/// Belongs to the drawing thread, whose OpenGL context must be current.
class GlPictureShelf final : public PictureShelf {
 public:
  /// \param pictures  by label; must outlive this object
  /// \param pitch_mm  of a pixel, > 0
  GlPictureShelf(const std::map<std::string, GreyImage>& pictures, double pitch_mm)
      : pictures_(pictures), pitch_mm_(pitch_mm) {}

  /// \return 40 mm x 40 mm if there is no such picture
  [[nodiscard]] Vec2 size_mm(const std::string& label) const override;
  [[nodiscard]] void* texture(const std::string& label, int width, int height) override;

  /// Deletes all textures, while the context is still current.
  void clear();
  /// \param density  screen pixels per window unit
  void set_density(double density) noexcept { density_ = density; }

 private:
  struct Texture {
    unsigned int name = 0;
    int width = 0;
    int height = 0;
  };

  const std::map<std::string, GreyImage>& pictures_;
  double pitch_mm_;
  double density_ = 1.0;
  std::map<std::string, Texture> textures_;
};

/// Draws what the exchange shows until it ends, with the window's OpenGL context, which it releases
/// afterwards. Draws nothing while nothing changes, so that the servo has the processor. The screen
/// takes one key or button per picture, so that its effect is seen before the next. Failures go to
/// the exchange.
/// \param glass  the scale that the screens read; only this function writes it
/// \param shelf  of the same OpenGL context; its textures are deleted at the end
/// \param look  must outlive the call
/// \param console  drawn between this window's pictures when it asks for it; null: no console
void draw_until_ended(GLFWwindow* window, WindowExchange& exchange, Glass& glass,
                      GlPictureShelf& shelf, const ScreenLook& look, ConsoleWindow* console);

}  // namespace touchtrial::app
