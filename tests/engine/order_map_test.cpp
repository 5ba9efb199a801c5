#include "engine/order_map.hpp"

#include "engine/csgv.hpp"
#include "engine/example_images.hpp"
#include "engine/plane_comparison.hpp"
#include "engine/reference/adaptive_reference.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace touchtrial {
namespace {

Plane<double> row_of(std::initializer_list<double> samples) {
  Plane<double> row(1, static_cast<int>(samples.size()));
  std::copy(samples.begin(), samples.end(), row.samples().begin());
  return row;
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

TEST_CASE("order_map of no gradient at all is zero") {
  CHECK(largest_magnitude(engine::order_map(Plane<double>(3, 4))) == 0.0);
}

TEST_CASE("order_map stays under one, even at the maximum") {
  for (const double largest : {2.0, 3.0, 127.0, 128.0, 128.5, 4000.0}) {
    CHECK(engine::order_map(row_of({0.0, largest})).at(0, 1) < 1.0);
  }
}

TEST_CASE("order_map gives orders from 0 to below 1 for every kind of image") {
  for (const auto& [name, image] : example_images({64, 63})) {
    const Plane<double> orders =
        engine::order_map(engine::composite_gradient(engine::daub4_sub_bands(image)));
    INFO(name);
    for (const double order : orders.samples()) REQUIRE((order >= 0.0 && order < 1.0));
  }
}

TEST_CASE("order_map agrees with its definition") {
  const Plane<double> csgv = reference::csgv(cloth_image({101, 99}));
  CHECK(largest_difference(engine::order_map(csgv), reference::order_map(csgv)) < 1e-15);
}

}  // namespace
}  // namespace touchtrial
