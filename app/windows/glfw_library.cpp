#include "app/windows/glfw_library.hpp"

#include "core/errors.hpp"

#include <GLFW/glfw3.h>

namespace touchtrial::app {

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

}  // namespace touchtrial::app
