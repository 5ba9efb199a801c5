/// \file A virtual screen, with a hand on its mouse and keyboard.
#pragma once

#include <memory>
#include <string>

namespace touchtrial {

/// A private X server (Xvfb) on a free display while this object lives. DISPLAY names it, and
/// OpenGL is rendered in software. Only one object may exist at a time.
///
/// Input comes from the XTest extension: real events, which are not addressed to a window, so that
/// a window may close at any of them. All functions return once the server has done the work, and
/// throw std::runtime_error if it refuses.
class VirtualScreen {
 public:
  /// \throws std::runtime_error if Xvfb is not installed or does not start
  [[nodiscard]] static std::unique_ptr<VirtualScreen> open(const std::string& size = "1280x1024");
  ~VirtualScreen();
  VirtualScreen(const VirtualScreen&) = delete;
  VirtualScreen& operator=(const VirtualScreen&) = delete;

  /// Moves the pointer; pixels from the screen's corner.
  void move_pointer(int x, int y) const;
  void press() const;
  void release() const;
  /// Presses and releases one key after the other, as X names them: "d o o r Return".
  void type(const std::string& keys) const;

  /// \name Windows, by their whole title
  ///@{
  /// \throws std::runtime_error if there is no such window
  void focus_window(const std::string& title) const;
  /// Takes the focus from every window, as a program of others does.
  void take_focus() const;
  /// Waits until the window's program has taken all events so far.
  /// \return false if there is no such window, or it closes meanwhile
  bool wait_until_heard(const std::string& title) const;
  ///@}

 private:
  class Client;
  VirtualScreen() = default;
  int server_ = -1;
  std::unique_ptr<Client> client_;
};

}  // namespace touchtrial
