#include "app/windows/glfw_support.hpp"

#include "core/errors.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include <GLFW/glfw3.h>

namespace touchtrial::app {
namespace {

constexpr double kMmPerInch = 25.4;

/// The area of the window on the monitor, window units squared.
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

/// Where the system hides the screen's density, a window unit already covers several pixels.
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

GlfwLibrary::GlfwLibrary() {
  if (glfwInit() != GLFW_TRUE) {
    refuse_window("run in a graphical session (DISPLAY or WAYLAND_DISPLAY), or under xvfb-run");
  }
}

GlfwLibrary::~GlfwLibrary() {
  glfwTerminate();
}

void refuse_window(const std::string& remedy) {
  const char* reason = nullptr;
  glfwGetError(&reason);
  throw DeviceError(one_line(
      "window: " + std::string(reason == nullptr ? "unknown error" : reason) + "; " + remedy));
}

void hint_opengl_3_2() {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 2);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
}

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

engine::ColourImage drawn_picture(int width, int height) {
  std::vector<unsigned char> bytes(static_cast<std::size_t>(width) * height * 3);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, bytes.data());
  engine::ColourImage picture(height, width);
  for (int y = 0; y < height; ++y) {
    const unsigned char* row = bytes.data() + static_cast<std::size_t>(height - 1 - y) * width * 3;
    for (int x = 0; x < width; ++x) {
      picture.at(y, x) = {row[3 * x], row[3 * x + 1], row[3 * x + 2]};
    }
  }
  return picture;
}

}  // namespace touchtrial::app
