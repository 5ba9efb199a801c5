/// \file GLFW itself, and how its refusals are passed on.
#pragma once

#include <string>

namespace touchtrial::app {

/// GLFW for as long as there is a window; one at a time. Main thread.
class GlfwLibrary {
 public:
  /// \throws DeviceError with the remedy if there is no display
  GlfwLibrary();
  ~GlfwLibrary();
  GlfwLibrary(const GlfwLibrary&) = delete;
  GlfwLibrary& operator=(const GlfwLibrary&) = delete;
};

/// \throws DeviceError always: GLFW's last error, and the remedy
[[noreturn]] void refuse_window(const std::string& remedy);

}  // namespace touchtrial::app
