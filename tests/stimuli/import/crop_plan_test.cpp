#include "stimuli/import/crop_plan.hpp"

#include "support/catch.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

using namespace touchtrial;
using namespace touchtrial::stimuli;

namespace {

bool share_a_pixel(CropPosition a, CropPosition b, int side_px) {
  return std::abs(a.x - b.x) < side_px && std::abs(a.y - b.y) < side_px;
}

bool lies_within(CropPosition place, PhotoSize photo, int side_px) {
  return place.x >= 0 && place.y >= 0 && place.x + side_px <= photo.width_px &&
         place.y + side_px <= photo.height_px;
}

}  // namespace

TEST_CASE("crops do not share a pixel while there is room, and never lie outside") {
  const PhotoSize photo{73, 101};
  REQUIRE(separate_crops(photo, 20) == 15);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    RandomStream random(seed, "crop plan test");
    const auto places = crop_positions(photo, 20, 15, random);
    REQUIRE(places.size() == 15);
    for (std::size_t i = 0; i < places.size(); ++i) {
      CHECK(lies_within(places[i], photo, 20));
      for (std::size_t j = 0; j < i; ++j) CHECK_FALSE(share_a_pixel(places[i], places[j], 20));
    }
  }
}

TEST_CASE("crops that must overlap share at most half their side and are all different") {
  const PhotoSize photo{50, 64};
  for (const int side_px : {30, 31}) {
    const int most = overlapping_crops(photo, side_px);
    REQUIRE(most > separate_crops(photo, side_px));
    for (int count = separate_crops(photo, side_px) + 1; count <= most; ++count) {
      RandomStream random(3, "crop plan test");
      const auto places = crop_positions(photo, side_px, count, random);
      REQUIRE(static_cast<int>(places.size()) == count);
      for (std::size_t i = 0; i < places.size(); ++i) {
        CHECK(lies_within(places[i], photo, side_px));
        for (std::size_t j = 0; j < i; ++j) {
          CHECK_FALSE(share_a_pixel(places[i], places[j], side_px / 2));
        }
      }
    }
  }
}

TEST_CASE("a photograph as large as a crop gives one crop, a smaller one none") {
  RandomStream random(1, "crop plan test");
  CHECK(crop_positions({20, 20}, 20, 1, random) == std::vector<CropPosition>{{0, 0}});
  CHECK(overlapping_crops({20, 20}, 20) == 1);
  CHECK(overlapping_crops({20, 19}, 20) == 0);
  CHECK(separate_crops({19, 200}, 20) == 0);
}

TEST_CASE("a seed decides where crops are cut") {
  const auto places = [](std::uint64_t seed) {
    RandomStream random(seed, "crop plan test");
    return crop_positions({200, 200}, 20, 4, random);
  };
  CHECK(places(1) == places(1));
  CHECK(places(1) != places(2));
}

TEST_CASE("photographs share the crops evenly, and separate crops come first") {
  const std::vector<PhotoSize> photos = {{20, 20}, {40, 40}, {30, 60}};
  CHECK(distribute_crops(photos, 20, 3) == std::vector<int>{1, 1, 1});
  CHECK(distribute_crops(photos, 20, 5) == std::vector<int>{1, 2, 2});
  CHECK(distribute_crops(photos, 20, 8) == std::vector<int>{1, 4, 3});
  CHECK(distribute_crops(photos, 20, 9) == std::vector<int>{1, 5, 3});
  CHECK(distribute_crops(photos, 20, 21).empty());
}

TEST_CASE(
    "the opaque part is the largest of the wanted size, or else the largest square, by search") {
  RandomStream random(3, "opaque part test");
  for (int round = 0; round < 300; ++round) {
    GreyImage opacity(1 + static_cast<int>(random.below(7)), 1 + static_cast<int>(random.below(7)));
    for (std::uint8_t& sample : opacity.samples()) sample = random.below(4) > 0 ? 255 : 0;
    const int min_px = 1 + static_cast<int>(random.below(5));
    const auto value = [&](PhotoSize size) {
      return std::pair(std::min({size.height_px, size.width_px, min_px}),
                       size.height_px * size.width_px);
    };
    std::pair most(0, 0);
    for (int top = 0; top < opacity.height(); ++top) {
      for (int left = 0; left < opacity.width(); ++left) {
        for (int height = 1; top + height <= opacity.height(); ++height) {
          for (int width = 1; left + width <= opacity.width(); ++width) {
            const GreyImage part = crop_image(opacity, {left, top, {height, width}});
            if (std::ranges::count(part.samples(), 0) == 0) {
              most = std::max(most, value({height, width}));
            }
          }
        }
      }
    }
    const PhotoPart found = opaque_part(opacity, min_px);
    CHECK(value(found.size_px) == most);
    CHECK(std::ranges::count(crop_image(opacity, found).samples(), 0) == 0);
  }
}
