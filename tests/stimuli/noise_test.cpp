#include "stimuli/noise.hpp"

#include "support/catch.hpp"

#include <cmath>

using namespace touchtrial;
using namespace touchtrial::stimuli;

TEST_CASE("noise is continuous, zero on its lattice and about zero on average") {
  const Noise noise(1, "test");
  double sum = 0.0;
  double largest = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const double x = 0.137 * i;
    const double y = 0.071 * i;
    CHECK(std::abs(noise.at(x + 1e-6, y) - noise.at(x, y)) < 1e-4);
    sum += noise.at(x, y);
    largest = std::max(largest, std::abs(noise.at(x, y)));
  }
  CHECK(std::abs(sum / 20000) < 0.05);
  CHECK(largest > 0.6);
  CHECK(largest < 1.6);
  CHECK(noise.at(5.0, -7.0) == 0.0);
}

TEST_CASE("noise of another seed or purpose is other noise") {
  const Noise a(1, "test");
  CHECK(a.at(0.3, 0.4) == Noise(1, "test").at(0.3, 0.4));
  CHECK(a.at(0.3, 0.4) != Noise(2, "test").at(0.3, 0.4));
  CHECK(a.at(0.3, 0.4) != Noise(1, "other").at(0.3, 0.4));
}

TEST_CASE("ridged noise lies between 0 and 1 with its crests near 1") {
  const Noise noise(3, "test");
  double largest = 0.0;
  for (int i = 0; i < 5000; ++i) {
    const double value = noise.ridged(0.037 * i, 0.053 * i, 1);
    REQUIRE(value >= 0.0);
    REQUIRE(value <= 1.0);
    largest = std::max(largest, value);
  }
  CHECK(largest > 0.99);
}

TEST_CASE("cells on a square grid have the distances of a square grid") {
  const Cells cells(1, "test", 0.0);
  CHECK(cells.at(0.5, 0.5).to_centre == Approx(0.0).margin(1e-12));
  CHECK(cells.at(0.5, 0.5).to_border == Approx(1.0));
  CHECK(cells.at(1.0, 0.5).to_border == Approx(0.0).margin(1e-12));
  CHECK(cells.at(0.9, 0.5).to_centre == Approx(0.4));
  CHECK(cells.at(3.2, 4.9).cell == cells.at(3.8, 4.1).cell);
}

TEST_CASE("the nearest of jittered cells is found as by a search of every centre") {
  // A point's distance to its centre never exceeds that of any nearby point plus the way there.
  const Cells cells(9, "test");
  for (int i = 0; i < 2000; ++i) {
    const double x = 0.31 * i;
    const double y = 0.17 * i;
    const double here = cells.at(x, y).to_centre;
    REQUIRE(std::abs(cells.at(x + 0.01, y).to_centre - here) <= 0.01 + 1e-12);
    REQUIRE(std::abs(cells.at(x, y + 0.01).to_centre - here) <= 0.01 + 1e-12);
  }
}

TEST_CASE("smooth_step runs either way") {
  CHECK(smooth_step(1.0, 3.0, 0.0) == 0.0);
  CHECK(smooth_step(1.0, 3.0, 2.0) == Approx(0.5));
  CHECK(smooth_step(1.0, 3.0, 9.0) == 1.0);
  CHECK(smooth_step(3.0, 1.0, 0.0) == 1.0);
  CHECK(smooth_step(3.0, 1.0, 9.0) == 0.0);
}
