/// \file A screen that nobody sees, and a hand on its mouse.
#pragma once

#include <memory>
#include <string>

namespace touchtrial {

/// An X server of its own (Xvfb) on a display that is free, for as long as this lives; DISPLAY
/// names it, and OpenGL is drawn by software. One at a time.
class VirtualScreen {
 public:
  /// \throws std::runtime_error where Xvfb or xdotool is not installed, or no screen is to be had
  [[nodiscard]] static std::unique_ptr<VirtualScreen> open(const std::string& size = "1280x1024");
  ~VirtualScreen();
  VirtualScreen(const VirtualScreen&) = delete;
  VirtualScreen& operator=(const VirtualScreen&) = delete;

  /// Real events by the XTest extension, as from a mouse; pixels from the screen's corner.
  void move_pointer(int x, int y) const;
  void press() const;
  void release() const;
  void type(const std::string& key) const;

  /// "xdotool ARGUMENTS". \throws std::runtime_error if it fails
  void xdotool(const std::string& arguments) const;

 private:
  VirtualScreen() = default;
  int server_ = -1;
};

}  // namespace touchtrial
