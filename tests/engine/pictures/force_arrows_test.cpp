#include "engine/pictures/force_arrows.hpp"

#include "core/errors.hpp"
#include "engine/example_images.hpp"
#include "engine/image_file.hpp"
#include "support/catch.hpp"
#include "support/refusal.hpp"
#include "support/temp_folder.hpp"

#include <algorithm>

namespace touchtrial {
namespace {

using namespace engine;

ForceField<double> force_of(const GreyImage& image) {
  return engine::tangential_force(converted<double>(image), 3);
}

/// A flat image with one square.
GreyImage square_in_flat(Size size, int top, int left, int side) {
  GreyImage image = flat_image(size, 100);
  for (int y = top; y < top + side; ++y) {
    for (int x = left; x < left + side; ++x) image.at(y, x) = 180;
  }
  return image;
}

TEST_CASE("the patch is where the force is strongest") {
  const ArrowPatch patch = engine::strongest_patch(force_of(square_in_flat({90, 120}, 60, 20, 10)));
  CHECK(patch.height == kArrowPatchSide_px);
  CHECK(patch.width == kArrowPatchSide_px);
  CHECK(patch.y <= 59);
  CHECK(patch.y + patch.height >= 71);
  CHECK(patch.x <= 19);
  CHECK(patch.x + patch.width >= 31);
  CHECK(patch.force_of_unit_arrow > 0.0);
}

TEST_CASE("the patch of a flat texture is its middle, without arrows") {
  const ArrowPatch patch = engine::strongest_patch(force_of(flat_image({100, 60}, 7)));
  CHECK(patch.y == 38);
  CHECK(patch.x == 18);
  CHECK(patch.force_of_unit_arrow == 0.0);
}

TEST_CASE("a texture smaller than a patch is the patch") {
  const ArrowPatch patch = engine::strongest_patch(force_of(noise_image({5, 30})));
  CHECK(patch.y == 0);
  CHECK(patch.height == 5);
  CHECK(patch.width == kArrowPatchSide_px);
}

TEST_CASE("arrows are drawn at the pixels beside a step, and nowhere else") {
  const TempFolder folder;
  const auto path = folder.path() / "arrows.png";
  const GreyImage step = step_image({24, 24}, 40, 200);  // brighter on the right
  (void)write_force_arrows(path, step, force_of(step));
  const GreyImage drawn = engine::read_grey_image(path);
  CHECK(drawn.height() == 720);
  CHECK(drawn.width() == 2 * 720 + 24);
  // Of the close-up's 30 x 30 squares, those beside the step hold arrows and all others none.
  const auto is_plain = [&](int column) {
    const int left = 720 + 24 + 30 * column;
    for (int x = left; x < left + 30; ++x) {
      if (drawn.at(375, x) != step.at(12, column)) return false;
    }
    return true;
  };
  CHECK(is_plain(8));
  CHECK_FALSE(is_plain(11));
  CHECK_FALSE(is_plain(12));
  CHECK(is_plain(14));
}

TEST_CASE("force arrows can be drawn for any size of texture") {
  const TempFolder folder;
  for (const Size size : {Size{1, 1}, Size{1, 3000}, Size{3000, 2}, Size{25, 7}}) {
    const GreyImage image = noise_image(size);
    CHECK_NOTHROW(write_force_arrows(folder.path() / "arrows.png", image, force_of(image)));
  }
}

TEST_CASE("force arrows refuse a field of another size and a missing folder") {
  const GreyImage image = noise_image({6, 7});
  CHECK_FALSE(message_of<std::invalid_argument>([&] {
                (void)write_force_arrows("x.png", image, force_of(noise_image({7, 6})));
              }).empty());
  CHECK_FALSE(message_of<std::invalid_argument>([] { (void)engine::strongest_patch({}); }).empty());
  CHECK_THROWS_AS(write_force_arrows("/no/such/folder/x.png", image, force_of(image)), FileError);
}

TEST_CASE("arrows are drawn over a patch that fills the square") {
  const GreyImage texture(30, 40, 100);
  ForceField<double> force{Plane<double>(30, 40), Plane<double>(30, 40)};
  force.x.at(12, 12) = 5.0;
  const ArrowPatch patch = engine::strongest_patch(force);
  const ColourImage picture = force_arrows(texture, force, patch, 120);
  REQUIRE(picture.height() == 120);
  REQUIRE(picture.width() == 120);
  const auto coloured = std::ranges::count_if(picture.samples(), [](const Rgb& pixel) {
    return pixel.red != pixel.green || pixel.green != pixel.blue;
  });
  CHECK(coloured > 0);
  CHECK(coloured < 300);
  CHECK_THROWS_AS((void)force_arrows(GreyImage(3, 3), force, patch, 120), std::invalid_argument);
  CHECK_THROWS_AS((void)force_arrows(texture, force, ArrowPatch{20, 0, 24, 24, 1.0}, 120),
                  std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial
