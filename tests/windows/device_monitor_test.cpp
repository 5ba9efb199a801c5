// "touchtrial device monitor" as its users run it, on a screen that nobody sees.
#include "engine/image_file.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"
#include "windows/virtual_screen.hpp"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <set>

namespace touchtrial {
namespace {

int monitor(const std::string& arguments) {
  const std::string command =
      std::string("'") + TOUCHTRIAL_PROGRAM + "' device monitor " + arguments;
  return std::system(command.c_str());
}

TEST_CASE("device monitor writes a picture of the window that is not blank") {
  const auto screen = VirtualScreen::open();
  if (!screen) return;
  const TempFolder folder;
  const auto file = folder.path() / "monitor.png";
  const std::string driver = GENERATE("simulated", "mouse");
  REQUIRE(monitor(driver + " --wall --seconds 1 --size 900 600 --screenshot '" + file.string() +
                  "'") == 0);
  const GreyImage picture = read_grey_image(file);
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
