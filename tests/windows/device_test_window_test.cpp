// "touchtrial device test" in a window, as its users run it, on a virtual screen.
#include "app/touchtrial_process.hpp"
#include "core/files.hpp"
#include "engine/image_file.hpp"
#include "support/catch.hpp"
#include "support/child_process.hpp"
#include "support/temp_folder.hpp"
#include "windows/virtual_screen.hpp"

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <set>

namespace touchtrial {
namespace {

int test_in_window(const std::string& arguments) {
  const std::string command = std::string("'") + TOUCHTRIAL_PROGRAM + "' device test " + arguments +
                              " --window < /dev/null > /dev/null";
  return std::system(command.c_str());
}

/// \return the last line of standard error
std::string last_line_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string last;
  for (std::string line; std::getline(file, line);) last = line;
  return last;
}

TEST_CASE("device test in a window that a signal ends exits as a shell expects") {
  const auto screen = VirtualScreen::open();
  const auto [name, signal] =
      GENERATE(table<std::string, int>({{"SIGINT", SIGINT}, {"SIGTERM", SIGTERM}}));
  testing::ChildProcess program(
      {TOUCHTRIAL_PROGRAM, "device", "test", "simulated", "--watch", "--window"}, {});
  while (!screen->has_window("Touchtrial: device test")) {
    INFO(program.output());
    REQUIRE(program.listen(std::chrono::milliseconds(20)));
  }
  REQUIRE(program.says("watch  "));  // the servo runs
  program.send_signal(signal);
  const int code = program.finish();
  const std::string& output = program.output();
  CHECK(code == 128 + signal);
  CHECK_THAT(output, holds_text("stopped by " + name) && holds_text("the force is zero"));
}

TEST_CASE("device test writes a picture of the window that is not blank") {
  const auto screen = VirtualScreen::open();
  const TempFolder folder;
  const auto file = folder.path() / "readings.png";
  const std::string driver = GENERATE("simulated", "mouse --watch");
  const auto errors = folder.path() / "errors";
  const int code = test_in_window(driver + " --seconds 1 --screenshot '" + file.string() +
                                  "' 2> '" + errors.string() + "'");
  // A busy machine may stall the servo, and then with exactly that fault.
  INFO(last_line_of(errors));
  CHECK((code == 0 || last_line_of(errors).find("stalled") != std::string::npos));
  const GreyImage picture = engine::read_grey_image(file);
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

TEST_CASE("device test without a display fails in one line with the remedy") {
  ::unsetenv("DISPLAY");
  const TempFolder folder;
  const auto errors = folder.path() / "errors";
  CHECK(test_in_window("simulated --seconds 1 2> '" + errors.string() + "'") != 0);
  CHECK_THAT(text_of(read_file(errors)), holds_text("graphical session"));
  CHECK(line_count(text_of(read_file(errors))) == 1);
}

}  // namespace
}  // namespace touchtrial
