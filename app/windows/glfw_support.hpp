/// \file What all windows share of GLFW and OpenGL: starting GLFW, the scale of a screen, and what
/// was drawn. Neither library shows here. Scales that somebody has measured with a card (`screen
/// calibrate`) are in screens.json in the user's configuration folder; format:
/// docs/data-dictionary.md, "Measured screens".
#pragma once

#include "engine/pictures/colour_image.hpp"

#include <filesystem>
#include <string>

struct GLFWwindow;

namespace touchtrial::app {

/// Starts GLFW for as long as there is a window, and reads the measured screens. There may be one
/// object at a time. It belongs to the main thread.
class GlfwLibrary {
 public:
  /// Warns if the measured screens cannot be read; there are none then.
  /// \throws DeviceError with the remedy if there is no display
  GlfwLibrary();
  ~GlfwLibrary();
  GlfwLibrary(const GlfwLibrary&) = delete;
  GlfwLibrary& operator=(const GlfwLibrary&) = delete;
};

/// \throws DeviceError always: GLFW's last error and the remedy
[[noreturn]] void refuse_window(const std::string& remedy);

/// Requests OpenGL 3.2 for the next window. Call it on the main thread while GLFW is running.
void hint_opengl_3_2();

/// The scale of the monitor that shows the largest part of a window.
struct ScreenScale {
  double mm_per_unit = 25.4 / 96.0;  ///< millimetres on the screen for one window unit
  bool is_known = false;             ///< measured, or the monitor states a size that can be true
  float density = 1.0F;              ///< factor for all sizes; 1 at 96 window units per inch
  double refresh_hz = 60.0;
  /// The monitor: its name, resolution, stated size and, where the system has it, a hash of its
  /// EDID (the monitor's own description of itself).
  std::string monitor{};
  bool is_measured = false;  ///< by `screen calibrate`
};

/// Call it on the main thread while GLFW is running.
[[nodiscard]] ScreenScale screen_scale(GLFWwindow* window);

/// \param size_mm  as the monitor states it: many projectors and emulators state 0 or nonsense
/// \param width  window units of the same monitor
/// \return millimetres for one window unit, or 0 where the statement cannot be true: outside 40 to
///   400 units per inch
[[nodiscard]] double stated_mm_per_unit(int size_mm, int width) noexcept;

/// Whether a stated size is the one that systems make up for a monitor that states none: 96 window
/// units per inch, to the millimetre.
[[nodiscard]] bool is_made_up(int size_mm, int width) noexcept;

/// \return screens.json in the user's configuration folder; empty if the system knows no home
[[nodiscard]] std::filesystem::path measured_screens_path();

/// Keeps a measured screen beside those that there are.
/// \param monitor  ScreenScale::monitor
/// \param mm_per_unit  25.4 / 400 to 25.4 / 40
/// \pre GLFW was started before
/// \throws FileError if the file cannot be written
void keep_measured_screen(const std::string& monitor, double mm_per_unit);

/// The picture of the current OpenGL context, before its buffers are swapped.
/// \param width,height  pixels, >= 1
[[nodiscard]] engine::ColourImage drawn_picture(int width, int height);

}  // namespace touchtrial::app
