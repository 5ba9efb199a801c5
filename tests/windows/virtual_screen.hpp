/// \file A screen that nobody sees, with a hand on its mouse and keyboard.
#pragma once

#include <memory>
#include <string>

namespace touchtrial {

/// An X server of its own (Xvfb) on a display that is free, for as long as this lives; DISPLAY
/// names it, and OpenGL is drawn by software. One at a time.
///
/// Input is that of the XTest extension: real events, of which none is meant for a certain window,
/// so that a window may close at any of them. All functions return once the server has done what
/// they ask for; they throw std::runtime_error where it refuses.
class VirtualScreen {
 public:
  /// \throws std::runtime_error where Xvfb is not installed, or no screen is to be had
  [[nodiscard]] static std::unique_ptr<VirtualScreen> open(const std::string& size = "1280x1024");
  ~VirtualScreen();
  VirtualScreen(const VirtualScreen&) = delete;
  VirtualScreen& operator=(const VirtualScreen&) = delete;

  /// Pixels from the screen's corner.
  void move_pointer(int x, int y) const;
  void press() const;
  void release() const;
  /// Presses and releases one key after the other, as X names them: "d o o r Return".
  void type(const std::string& keys) const;

  /// \name Windows, by their whole title
  ///@{
  [[nodiscard]] bool has_window(const std::string& title) const;
  /// \throws std::runtime_error, as the following, if there is no such window
  void move_window(const std::string& title, int x, int y) const;
  void resize_window(const std::string& title, int width, int height) const;
  void focus_window(const std::string& title) const;
  /// Waits until the window's program has taken everything that has happened on the screen so far.
  /// \return false if there is no such window, or it is closed meanwhile
  bool wait_until_heard(const std::string& title) const;
  ///@}

 private:
  class Client;
  VirtualScreen() = default;
  int server_ = -1;
  std::unique_ptr<Client> client_;
};

}  // namespace touchtrial
