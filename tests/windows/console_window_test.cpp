// The experimenter's window beside the participant's, on a screen that nobody sees.
#include "app/experimenter/console_experimenter.hpp"
#include "app/participant/participant_window.hpp"
#include "device/servo/servo_control.hpp"
#include "engine/pictures/colour_image.hpp"
#include "support/catch.hpp"
#include "windows/virtual_screen.hpp"

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace touchtrial {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
using Kind = ExperimenterRequest::Kind;

constexpr int kParticipantWidth = 1280;

SessionStatus status(const std::string& stage = "answering") {
  SessionStatus now;
  now.participant = "P07";
  now.stage = stage;
  now.trial = 7;
  now.of = 25;
  now.elapsed = std::chrono::seconds(754);
  now.device = "Falcon 1, serial 4711";
  now.rate_hz = 1000.0;
  now.lateness_p99_us = 41.0;
  now.interruptions = 1;
  return now;
}

ParticipantWindowOptions options(ConsoleExperimenter& console) {
  ParticipantWindowOptions all;
  all.size_px = {kParticipantWidth, 720};
  all.console = &console;
  return all;
}

/// Both windows side by side, with a hand on mouse and keyboard.
struct Room {
  Room() : screen(VirtualScreen::open("2240x1080")), window(options(console)) {
    window.see_pictures({"bark", "cloth"});
    screen->xdotool("search --name '^Touchtrial$' windowmove 0 0");
    screen->xdotool("search --name '^Touchtrial console$' windowmove 1280 0");
  }

  template <typename Session>
  void run(const Session& session) {
    run_beside(window, [&] { session(); });
  }

  void settle() { static_cast<void>(window.console_picture()); }

  /// Clicks in the experimenter's window.
  void click(std::pair<int, int> at) {
    screen->move_pointer(kParticipantWidth + at.first, at.second);
    screen->press();
    screen->release();
    std::this_thread::sleep_for(milliseconds(300));
    settle();
  }

  void type(const std::string& keys) {
    screen->type(keys);
    std::this_thread::sleep_for(milliseconds(300));
    settle();
  }

  /// Waits for the next request, 20 s at most.
  std::optional<ExperimenterRequest> request() {
    const auto give_up = steady_clock::now() + std::chrono::seconds(20);
    while (steady_clock::now() < give_up) {
      if (auto asked = console.request()) return asked;
      std::this_thread::sleep_for(milliseconds(5));
    }
    return std::nullopt;
  }

  Experimenter nobody;
  ConsoleExperimenter console{nobody};
  std::unique_ptr<VirtualScreen> screen;
  ParticipantWindow window;
};

void keep(const ColourImage& picture, const std::string& name) {
  const char* const folder = std::getenv("TOUCHTRIAL_SCREENSHOTS");
  REQUIRE(folder != nullptr);
  const Bytes png = png_bytes(picture);
  std::ofstream(std::filesystem::path(folder) / (name + ".png"), std::ios::binary)
      .write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
}

TEST_CASE("screenshots of every state of the console, for TOUCHTRIAL_SCREENSHOTS=FOLDER", "[.]") {
  Room room;
  room.run([&] {
    keep(room.window.console_picture(), "console-empty");
    room.console.show(status());
    keep(room.window.console_picture(), "console");
  });
}

}  // namespace
}  // namespace touchtrial
