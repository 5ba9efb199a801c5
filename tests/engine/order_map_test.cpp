#include "engine/order_map.hpp"

#include "engine/example_images.hpp"
#include "engine/kernels/strips.hpp"
#include "engine/plane_comparison.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

#include <tbb/task_arena.h>

namespace touchtrial {
namespace {

Plane<double> row_of(std::initializer_list<double> samples) {
  Plane<double> row(1, static_cast<int>(samples.size()));
  std::copy(samples.begin(), samples.end(), row.samples().begin());
  return row;
}

Plane<double> csgv_of(const GreyImage& image) {
  return engine::doubled<double>(engine::composite_gradient(engine::daub4_sub_bands(image)),
                                 image.height(), image.width());
}

TEST_CASE("csgv of a flat image is exactly zero") {
  for (int level = 0; level < 256; level += 5) {
    const GreyImage image = flat_image({9, 12}, level);
    CHECK(largest_magnitude(csgv_of(image)) == 0.0);
  }
}

TEST_CASE("csgv of a ramp is 32 times its slope inside") {
  // LL doubles the level and halves the pixels, so its slope is 4 s; Sobel has a gain of 8.
  const Plane<double> csgv = csgv_of(ramp_image({24, 30}, 3));
  for (int x = 4; x < 24; ++x) CHECK(csgv.at(11, x) == Approx(96.0).epsilon(1e-12));
}

TEST_CASE("doubled repeats every sample in a square of 2 x 2, cropped at an odd edge") {
  Plane<double> half(2, 2);
  half.at(0, 1) = 1.0;
  half.at(1, 0) = 2.0;
  half.at(1, 1) = 3.0;
  const Plane<float> full = engine::doubled<float>(half, 3, 4);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 4; ++x) CHECK(full.at(y, x) == static_cast<float>(half.at(y / 2, x / 2)));
  }
}

TEST_CASE("order_map has three branches, and both thresholds belong to the middle one") {
  const double above = std::nextafter(128.0, 200.0);
  const double below = std::nextafter(2.0, 0.0);
  const Plane<double> orders =
      engine::order_map(row_of({0.0, below, 2.0, 64.0, 128.0, above, 200.0}));
  const Plane<double> expected =
      row_of({0.0, 0.0, 2.0 / 600 + 0.666, 64.0 / 600 + 0.666, 128.0 / 600 + 0.666,
              128.0 / 400 + 0.499, 200.0 / 400 + 0.499});
  CHECK(largest_difference(orders, expected) < 1e-15);
}

TEST_CASE("order_map is zero if there is no gradient") {
  CHECK(largest_magnitude(engine::order_map(Plane<double>(3, 4))) == 0.0);
}

TEST_CASE("order_map stays under one, even at the maximum") {
  for (const double largest : {2.0, 3.0, 127.0, 128.0, 128.5, 4000.0}) {
    CHECK(engine::order_map(row_of({0.0, largest})).at(0, 1) < 1.0);
  }
}

TEST_CASE(
    "a megapixel of orders is made by several threads at once, to the same digits as by one") {
  const engine::SubBands fine = engine::daub4_sub_bands(cloth_image({2021, 2007}));
  const std::array<engine::SubBands, 2> levels{fine, engine::daub4_sub_bands(fine.ll)};
  REQUIRE(static_cast<std::int64_t>(fine.ll.size()) >= engine::kMinParallelPixels);
  const auto combine = GENERATE(engine::Combine::sum, engine::Combine::l2, engine::Combine::max);
  const auto orders = [&] {
    return engine::order_map(engine::composite_gradient(levels, engine::Gradient::sobel, combine));
  };
  const Plane<double> all = orders();
  Plane<double> alone;
  tbb::task_arena one(1);
  one.execute([&] { alone = orders(); });
  CHECK(all == alone);
}

}  // namespace
}  // namespace touchtrial
