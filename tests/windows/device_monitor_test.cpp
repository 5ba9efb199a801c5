// "touchtrial device monitor" as its users run it, on a screen that nobody sees.
#include "engine/image_file.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"
#include "windows/virtual_screen.hpp"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <sys/wait.h>
#include <unistd.h>

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

/// Whether it ends as it should: well, or, where a busy machine let the servo stand still, with
/// exactly that fault.
bool monitors(const std::string& arguments) {
  const TempFolder folder;
  const auto errors = folder.path() / "errors";
  const bool is_well = monitor(arguments + " 2> '" + errors.string() + "'") == 0;
  const std::string line = first_line_of(errors);
  return is_well ? line.empty() : line.find("the servo stood still") != std::string::npos;
}

/// The program with a simulated hand on the wall, until it is sent this signal.
/// \return as waitpid
int status_after(int signal, const std::filesystem::path& errors) {
  const pid_t child = ::fork();
  if (child == 0) {
    if (std::freopen(errors.c_str(), "w", stderr) == nullptr) ::_exit(98);
    ::execl(TOUCHTRIAL_PROGRAM, TOUCHTRIAL_PROGRAM, "device", "monitor", "simulated", "--wall",
            static_cast<char*>(nullptr));
    ::_exit(99);
  }
  // The window is there.
  const int found =
      std::system("timeout 60 xdotool search --sync --name 'device monitor' >/dev/null");
  ::kill(child, found == 0 ? signal : SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  return status;
}

TEST_CASE("device monitor that is asked to end by a signal leaves as a shell expects") {
  const auto screen = VirtualScreen::open();
  const TempFolder folder;
  const auto [name, signal] =
      GENERATE(table<std::string, int>({{"SIGINT", SIGINT}, {"SIGTERM", SIGTERM}}));
  const auto errors = folder.path() / "errors";
  const int status = status_after(signal, errors);
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 128 + signal);
  CHECK_THAT(first_line_of(errors), holds_text("stopped by " + name));
  CHECK_THAT(first_line_of(errors), holds_text("the force is zero"));
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
  // Plots on a light ground, with letters, lines and the state's band in colour.
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
