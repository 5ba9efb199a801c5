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
  std::set<char32_t> letters;  ///< letters in the fonts from the first frame
};

/// The window's state, set by the main thread.
struct WindowSurface {
  Vec2 size;         ///< window units
  int width_px = 0;  ///< width of the picture
  int height_px = 0;
  PhysicalScale physical_scale;
  double refresh_hz = 60.0;
};

/// The exchange between the threads. All functions are thread-safe and do not block, except those
/// described as waiting.
class WindowExchange {
 public:
  /// The next work of the drawing thread.
  struct Work {
    std::shared_ptr<Screen> screen;
    WindowSurface surface;
    std::vector<InputEvent> events;
    bool picture_requested = false;
    bool ending = false;
    bool is_new = true;  ///< there was input since the last call
  };

  /// \name Session's thread
  ///@{
  void show(std::shared_ptr<Screen> screen);
  /// Waits for the screen's reply.
  /// \return the reply, once; nothing after the timeout
  [[nodiscard]] std::optional<session::StepReply> reply(const Screen& screen,
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
  /// Waits for new work, or until `timeout` has passed.
  [[nodiscard]] Work wait_for_work(std::chrono::milliseconds timeout);
  /// \param events_left  whether events for the screen are still pending
  void mark_shown(const std::shared_ptr<Screen>& screen, bool events_left);
  void set_reply(const std::shared_ptr<Screen>& screen, const session::StepReply& reply);
  void set_picture(engine::ColourImage picture);
  void set_failure(std::exception_ptr failure);
  ///@}

  /// Wakes the drawing thread, for instance for the console.
  void wake();
  [[nodiscard]] WindowSurface surface() const;
  /// Waits until the newest screen is visible and has handled all events.
  /// \return false after the timeout
  [[nodiscard]] bool wait_until_shown(std::chrono::milliseconds timeout);
  /// Waits for the next picture.
  /// \return nothing after the timeout
  [[nodiscard]] std::optional<engine::ColourImage> picture(std::chrono::milliseconds timeout);
  /// \throws the drawing thread's exception
  void check() const;

 private:
  mutable std::mutex mutex_;
  std::condition_variable drawing_condition_;
  std::condition_variable result_condition_;
  std::shared_ptr<Screen> screen_;
  std::shared_ptr<Screen> shown_screen_;
  std::shared_ptr<Screen> reply_screen_;
  std::optional<session::StepReply> reply_;
  WindowSurface surface_;
  std::vector<InputEvent> events_;
  std::optional<engine::ColourImage> picture_;
  std::exception_ptr failure_;
  bool picture_requested_ = false;
  bool is_dirty_ = true;
  bool is_woken_ = false;
  bool has_shown_events_ = false;  ///< the last picture shows the effect of all events
  bool is_ending_ = false;
};

class ConsoleWindow;

/// Pictures as OpenGL textures, each resized to the size at which it is shown.
/// Belongs to the drawing thread, whose OpenGL context must be current.
class GlPictureShelf final : public PictureShelf {
 public:
  /// \param pictures  pictures by label; must outlive this object
  /// \param pitch_mm  size of a pixel, > 0
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
/// afterwards. Draws nothing while nothing changes, which leaves the processor to the servo. The
/// screen handles one key or button per picture, so that its effect is seen before the next.
/// Failures go to the exchange.
/// \param physical_scale  the scale that the screens read; only this function writes it
/// \param shelf  a shelf of the same OpenGL context; its textures are deleted at the end
/// \param look  must outlive the call
/// \param console  drawn between this window's frames when it needs one; null: no console
void draw_until_ended(GLFWwindow* window, WindowExchange& exchange, PhysicalScale& physical_scale,
                      GlPictureShelf& shelf, const ScreenLook& look, ConsoleWindow* console);

}  // namespace touchtrial::app
