/// \file The shared GLFW and OpenGL code of all windows: initialisation, the scale of a screen, and
/// screenshots. Neither library is exposed. Scales measured with a card (`screen calibrate`) are
/// stored in screens.json in the user's configuration folder; format: docs/data-dictionary.md,
/// "Measured screens".
#pragma once

#include "core/units.hpp"
#include "engine/pictures/colour_image.hpp"

#include <filesystem>
#include <string>

struct GLFWwindow;

namespace touchtrial::app {

/// Initialises GLFW for its lifetime, and reads the measured screens. One object at a time, on the
/// main thread.
class GlfwLibrary {
 public:
  /// Warns if the measured screens cannot be read, and ignores them.
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
  double mm_per_unit = kMmPerInch / 96.0;  ///< millimetres on the screen for one window unit
  bool is_known = false;                   ///< measured, or stated plausibly by the monitor
  float density = 1.0F;                    ///< factor for all sizes; 1 at 96 window units per inch
  double refresh_hz = 60.0;
  /// The monitor: its name, resolution, stated size and, if available, a hash of its EDID (the
  /// monitor's self-description).
  std::string monitor{};
  bool is_measured = false;  ///< measured by `screen calibrate`
};

/// Call it on the main thread while GLFW is running.
[[nodiscard]] ScreenScale screen_scale(GLFWwindow* window);

/// \param size_mm  as stated by the monitor: many projectors and emulators state 0 or nonsense
/// \param width  window units of the same monitor
/// \return millimetres for one window unit, or 0 if implausible: outside 40 to 400 units per inch
[[nodiscard]] double stated_mm_per_unit(int size_mm, int width) noexcept;

/// Whether a size is the system's default for a monitor that states none: 96 window units per inch,
/// to the millimetre.
[[nodiscard]] bool is_default_size(int size_mm, int width) noexcept;

/// \return screens.json in the user's configuration folder; empty without a home folder
[[nodiscard]] std::filesystem::path measured_screens_path();

/// Adds a measured screen to the file.
/// \param monitor  ScreenScale::monitor
/// \param mm_per_unit  25.4 / 400 to 25.4 / 40
/// \pre GLFW was started before
/// \throws FileError if the file cannot be written
void save_measured_screen(const std::string& monitor, double mm_per_unit);

/// The picture of the current OpenGL context, before its buffers are swapped.
/// \param width,height  pixels, >= 1
[[nodiscard]] engine::ColourImage capture_frame(int width, int height);

}  // namespace touchtrial::app
