/// \file How large things are on the screen.
#pragma once

struct GLFWwindow;

namespace touchtrial::app {

/// Of the monitor that shows most of a window.
struct ScreenScale {
  double mm_per_unit = 25.4 / 96.0;  ///< of the glass for one window unit
  bool is_known = false;             ///< the monitor stated a size that can be true
  float density = 1.0F;              ///< window units that text is to have for each at 96 per inch
  double refresh_hz = 60.0;
};

/// Main thread, GLFW running.
[[nodiscard]] ScreenScale screen_scale(GLFWwindow* window);

/// The density of the primary monitor, for a window that is yet to be made.
[[nodiscard]] float primary_density();

/// \param size_mm  as the monitor states it: 0 or nonsense from many projectors and emulators
/// \param width  window units of the same monitor
/// \return mm for one window unit, or 0 where the statement cannot be true: outside 40 to 400 units
///   to the inch
[[nodiscard]] double stated_mm_per_unit(int size_mm, int width) noexcept;

}  // namespace touchtrial::app
