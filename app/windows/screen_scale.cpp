#include "app/windows/screen_scale.hpp"

#include <algorithm>

#include <GLFW/glfw3.h>

namespace touchtrial::app {
namespace {

constexpr double kMmPerInch = 25.4;

/// Window units that the monitor has of the window.
int overlap(GLFWwindow* window, GLFWmonitor* monitor) {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
  glfwGetWindowPos(window, &x, &y);
  glfwGetWindowSize(window, &width, &height);
  int monitor_x = 0;
  int monitor_y = 0;
  glfwGetMonitorPos(monitor, &monitor_x, &monitor_y);
  const GLFWvidmode* mode = glfwGetVideoMode(monitor);
  if (mode == nullptr) return 0;
  const int across = std::min(x + width, monitor_x + mode->width) - std::max(x, monitor_x);
  const int down = std::min(y + height, monitor_y + mode->height) - std::max(y, monitor_y);
  return std::max(across, 0) * std::max(down, 0);
}

GLFWmonitor* monitor_of(GLFWwindow* window) {
  int count = 0;
  GLFWmonitor** monitors = glfwGetMonitors(&count);
  GLFWmonitor* best = glfwGetPrimaryMonitor();
  int most = 0;
  for (int i = 0; i < count; ++i) {
    const int shown = overlap(window, monitors[i]);
    if (shown > most) best = monitors[i];
    most = std::max(most, shown);
  }
  return best;
}

/// Where the system hides the screen's density, a window unit is several pixels already.
float density_of(GLFWwindow* window) {
  float content = 1.0F;
  glfwGetWindowContentScale(window, &content, nullptr);
  int units = 0;
  int pixels = 0;
  glfwGetWindowSize(window, &units, nullptr);
  glfwGetFramebufferSize(window, &pixels, nullptr);
  if (units <= 0 || pixels <= 0) return 1.0F;
  const float hidden = static_cast<float>(pixels) / static_cast<float>(units);
  return std::clamp(content / hidden, 1.0F, 4.0F);
}

}  // namespace

ScreenScale screen_scale(GLFWwindow* window) {
  ScreenScale scale;
  scale.density = density_of(window);
  scale.mm_per_unit = kMmPerInch / 96.0 / static_cast<double>(scale.density);
  GLFWmonitor* monitor = monitor_of(window);
  const GLFWvidmode* mode = monitor == nullptr ? nullptr : glfwGetVideoMode(monitor);
  if (mode == nullptr) return scale;
  if (mode->refreshRate > 0) scale.refresh_hz = mode->refreshRate;
  int width_mm = 0;
  glfwGetMonitorPhysicalSize(monitor, &width_mm, nullptr);
  const double stated = stated_mm_per_unit(width_mm, mode->width);
  scale.is_known = stated > 0.0;
  if (scale.is_known) scale.mm_per_unit = stated;
  return scale;
}

float primary_density() {
  float density = 1.0F;
#ifndef __APPLE__
  // On macOS window units hide the density.
  if (GLFWmonitor* monitor = glfwGetPrimaryMonitor()) {
    glfwGetMonitorContentScale(monitor, &density, nullptr);
  }
#endif
  return std::clamp(density, 1.0F, 4.0F);
}

double stated_mm_per_unit(int size_mm, int width) noexcept {
  if (size_mm <= 0 || width <= 0) return 0.0;
  const double mm_per_unit = static_cast<double>(size_mm) / width;
  const bool can_be_true = mm_per_unit <= kMmPerInch / 40.0 && mm_per_unit >= kMmPerInch / 400.0;
  return can_be_true ? mm_per_unit : 0.0;
}

}  // namespace touchtrial::app
