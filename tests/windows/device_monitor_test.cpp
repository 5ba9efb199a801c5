// "touchtrial device monitor" as its users run it, on a virtual screen.
#include "engine/image_file.hpp"
#include "support/catch.hpp"
#include "support/child_process.hpp"
#include "support/temp_folder.hpp"
#include "windows/virtual_screen.hpp"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

namespace touchtrial {
namespace {

int monitor(const std::string& arguments) {
  const std::string command =
      std::string("'") + TOUCHTRIAL_PROGRAM + "' device monitor " + arguments;
  return std::system(command.c_str());
}

std::string first_line_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

/// Whether it ends correctly: without a fault, or, if a busy machine stalled the servo, with
/// exactly that fault.
bool monitors(const std::string& arguments) {
  const TempFolder folder;
  const auto errors = folder.path() / "errors";
  const bool is_well = monitor(arguments + " 2> '" + errors.string() + "'") == 0;
  const std::string line = first_line_of(errors);
  return is_well ? line.empty() : line.find("the servo stalled") != std::string::npos;
}

TEST_CASE("device monitor that a signal ends exits as a shell expects") {
  const auto screen = VirtualScreen::open();
  const auto [name, signal] =
      GENERATE(table<std::string, int>({{"SIGINT", SIGINT}, {"SIGTERM", SIGTERM}}));
  testing::ChildProcess program({TOUCHTRIAL_PROGRAM, "device", "monitor", "simulated", "--wall"},
                                {});
  while (!screen->has_window("Touchtrial: device monitor, simulated")) {
    INFO(program.output());
    REQUIRE(program.listen(std::chrono::milliseconds(20)));
  }
  program.send_signal(signal);
  const int code = program.finish();
  const std::string& output = program.output();
  CHECK(code == 128 + signal);
  CHECK_THAT(output.substr(0, output.find('\n')),
             holds_text("stopped by " + name) && holds_text("the force is zero"));
}

TEST_CASE("device monitor writes a picture of the window that is not blank") {
  const auto screen = VirtualScreen::open();
  const TempFolder folder;
  const auto file = folder.path() / "monitor.png";
  const std::string driver = GENERATE("simulated", "mouse");
  REQUIRE(
      monitors(driver + " --wall --seconds 1 --size 900 600 --screenshot '" + file.string() + "'"));
  const GreyImage picture = engine::read_grey_image(file);
  CHECK(picture.width() == 900);
  CHECK(picture.height() == 600);
  std::set<int> levels;
  double light = 0.0;
  for (const auto sample : picture.samples()) {
    levels.insert(sample);
    light += sample > 200 ? 1.0 : 0.0;
  }
  light /= static_cast<double>(picture.size());
  // Plots on a light background, with letters, lines and the coloured band of the state.
  CHECK(levels.size() > 50);
  CHECK(light > 0.5);
  CHECK(light < 0.97);
}

TEST_CASE("device monitor without a display fails in one line with the remedy") {
  ::unsetenv("DISPLAY");
  const TempFolder folder;
  const auto errors = folder.path() / "errors";
  CHECK(monitor("simulated --seconds 1 2> '" + errors.string() + "'") != 0);
  std::ifstream file(errors);
  std::string line;
  REQUIRE(std::getline(file, line));
  CHECK_THAT(line, holds_text("graphical session"));
  CHECK_FALSE(std::getline(file, line));
}

}  // namespace
}  // namespace touchtrial
