#include "engine/pictures/colour_image.hpp"

#include "core/files.hpp"
#include "engine/image_file.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <stdexcept>

using namespace touchtrial;
using namespace touchtrial::engine;

TEST_CASE("png_bytes gives the file that write_png writes, and encodes colours") {
  const TempFolder folder;
  const auto path = folder.path() / "picture.png";
  GreyImage grey(3, 5);
  for (std::size_t i = 0; i < grey.size(); ++i) {
    grey.samples()[i] = static_cast<std::uint8_t>(16 * i);
  }
  write_png(path, grey);
  CHECK(read_file(path) == png_bytes(grey));

  ColourImage colours(1, 3);
  colours.at(0, 0) = {255, 0, 0};
  colours.at(0, 1) = {0, 255, 0};
  colours.at(0, 2) = {0, 0, 255};
  replace_file(path, png_bytes(colours));
  const GreyImage read = read_grey_image(path);
  CHECK(read.at(0, 0) == 76);
  CHECK(read.at(0, 1) == 150);
  CHECK(read.at(0, 2) == 29);
  CHECK_THROWS_AS((void)png_bytes(GreyImage()), std::invalid_argument);
  CHECK_THROWS_AS((void)png_bytes(ColourImage()), std::invalid_argument);
}

TEST_CASE("a picture shrinks to the means of its parts") {
  GreyImage image(4, 6);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 6; ++x) image.at(y, x) = static_cast<std::uint8_t>(10 * (x / 2) + x % 2);
  }
  const GreyImage half = resized(image, 2, 3);
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 3; ++x) CHECK(half.at(y, x) == 10 * x + 1);  // x.5 rounds up
  }
  CHECK(resized(image, 4, 6) == image);
}

TEST_CASE("an enlarged picture stays within its grey levels") {
  GreyImage image(2, 2);
  image.at(0, 0) = 255;
  const GreyImage large = resized(image, 9, 11);
  CHECK(large.height() == 9);
  CHECK(large.width() == 11);
  CHECK(large.at(0, 0) >= 250);
  CHECK(large.at(8, 10) <= 5);
  CHECK(resized(GreyImage(3, 3, 200), 7, 5) == GreyImage(7, 5, 200));
  CHECK_THROWS_AS((void)resized(GreyImage(), 1, 1), std::invalid_argument);
  CHECK_THROWS_AS((void)resized(image, 0, 1), std::invalid_argument);
}
