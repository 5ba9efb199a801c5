#include "windows/virtual_screen.hpp"

#include <array>
#include <cstdlib>
#include <stdexcept>

#include <sys/wait.h>
#include <unistd.h>

namespace touchtrial {
namespace {

bool is_installed(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null").c_str()) == 0;
}

[[noreturn]] void become_server(int number_to, const std::string& size) {
  const std::string descriptor = std::to_string(number_to);
  const std::string screen = size + "x24";
  ::execlp("Xvfb", "Xvfb", "-displayfd", descriptor.c_str(), "-screen", "0", screen.c_str(),
           "-nolisten", "tcp", "-noreset", "-r", static_cast<char*>(nullptr));
  ::_exit(127);
}

/// The number that the server writes once it takes clients; "" if it ended instead.
std::string display_number(int from) {
  std::string number;
  for (char c = 0; ::read(from, &c, 1) == 1 && c != '\n';) number += c;
  return number;
}

}  // namespace

std::unique_ptr<VirtualScreen> VirtualScreen::open(const std::string& size) {
  if (!is_installed("Xvfb") || !is_installed("xdotool")) {
    throw std::runtime_error("Xvfb or xdotool is not installed; run scripts/install-dependencies");
  }
  std::array<int, 2> pipe{};
  if (::pipe(pipe.data()) != 0) throw std::runtime_error("no pipe");
  std::unique_ptr<VirtualScreen> screen(new VirtualScreen);
  screen->server_ = ::fork();
  if (screen->server_ == 0) become_server(pipe[1], size);
  ::close(pipe[1]);
  const std::string number = display_number(pipe[0]);
  ::close(pipe[0]);
  if (number.empty()) throw std::runtime_error("Xvfb did not start");
  ::setenv("DISPLAY", (":" + number).c_str(), 1);
  ::setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  ::unsetenv("WAYLAND_DISPLAY");
  return screen;
}

VirtualScreen::~VirtualScreen() {
  if (server_ <= 0) return;
  ::kill(server_, SIGTERM);
  ::waitpid(server_, nullptr, 0);
  ::unsetenv("DISPLAY");
}

void VirtualScreen::xdotool(const std::string& arguments) const {
  // Two questions, of which the second is asked when the first is answered: by then the server has
  // sent what the arguments made happen to whom it concerns.
  const std::string questions = " getmouselocation getmouselocation >/dev/null";
  if (std::system(("xdotool " + arguments + questions).c_str()) != 0) {
    throw std::runtime_error("xdotool " + arguments + " failed");
  }
}

void VirtualScreen::move_pointer(int x, int y) const {
  xdotool("mousemove " + std::to_string(x) + " " + std::to_string(y));
}

void VirtualScreen::press() const {
  xdotool("mousedown 1");
}

void VirtualScreen::release() const {
  xdotool("mouseup 1");
}

void VirtualScreen::type(const std::string& key) const {
  xdotool("key " + key);
}

}  // namespace touchtrial
