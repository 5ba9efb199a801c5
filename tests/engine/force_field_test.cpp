#include "engine/force_field.hpp"

#include "engine/example_images.hpp"
#include "engine/plane_comparison.hpp"
#include "engine/reference/force_reference.hpp"
#include "support/catch.hpp"

#include <climits>
#include <stdexcept>

namespace touchtrial {
namespace {

Plane<double> surface_of(const GreyImage& image) {
  return converted<double>(image);
}

TEST_CASE("tangential_force of a unit ramp is -4 inside and -2 on the edge columns") {
  Plane<double> surface(6, 7);
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 7; ++x) surface.at(y, x) = x;
  }
  const engine::ForceField<double> force = engine::tangential_force(surface, 3);
  for (int y = 1; y < 5; ++y) {
    CHECK(force.x.at(y, 0) == -2.0);
    for (int x = 1; x < 6; ++x) CHECK(force.x.at(y, x) == -4.0);
    CHECK(force.x.at(y, 6) == -2.0);
    for (int x = 1; x < 6; ++x) CHECK(force.y.at(y, x) == 0.0);
  }
}

TEST_CASE("tangential_force of a flat surface is exactly zero") {
  for (const int n : {3, 5, 9}) {
    const engine::ForceField<float> force = engine::tangential_force(Plane<float>(6, 5, 128.3F), n);
    CHECK(largest_magnitude(force.x) == 0.0);
    CHECK(largest_magnitude(force.y) == 0.0);
  }
}

TEST_CASE("tangential_force agrees with Eqs. 10-12 at every size and neighbourhood") {
  for (const Size size : awkward_sizes()) {
    for (const int n : {3, 5, 7, 19}) {
      const Plane<double> surface = surface_of(noise_image(size));
      const engine::ForceField<double> expected = reference::tangential_force(surface, n);
      const engine::ForceField<double> exact = engine::tangential_force(surface, n);
      const engine::ForceField<float> single =
          engine::tangential_force(converted<float>(surface), n);
      INFO("n " << n << ", " << size.height << " x " << size.width);
      CHECK(largest_relative_difference(exact.x, expected.x) < 1e-11);
      CHECK(largest_relative_difference(exact.y, expected.y) < 1e-11);
      CHECK(largest_difference(single.x, expected.x) < 2e-3);
      CHECK(largest_difference(single.y, expected.y) < 2e-3);
    }
  }
}

TEST_CASE("tangential_force agrees with Eqs. 10-12 on real stimulus sizes") {
  for (const Size size : stimulus_sizes()) {
    const Plane<double> surface = surface_of(cloth_image(size));
    const engine::ForceField<double> expected = reference::tangential_force(surface, 3);
    const engine::ForceField<double> force = engine::tangential_force(surface, 3);
    CHECK(largest_relative_difference(force.x, expected.x) < 1e-11);
    CHECK(largest_relative_difference(force.y, expected.y) < 1e-11);
  }
}

TEST_CASE("tangential_force accepts a neighbourhood far larger than the surface") {
  const Plane<double> surface = surface_of(noise_image({5, 4}));
  const engine::ForceField<double> whole = engine::tangential_force(surface, 9);
  const engine::ForceField<double> more = engine::tangential_force(surface, INT_MAX);
  CHECK(more.x == whole.x);
  CHECK(more.y == whole.y);
}

TEST_CASE("tangential_force refuses an invalid neighbourhood and an empty surface") {
  const Plane<double> surface(4, 4);
  for (const int n : {-3, 0, 1, 2, 4, INT_MIN}) {
    INFO("n " << n);
    CHECK_THROWS_AS(engine::tangential_force(surface, n), std::invalid_argument);
  }
  CHECK_THROWS_AS(engine::tangential_force(Plane<float>(), 3), std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial
