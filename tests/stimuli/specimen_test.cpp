#include "stimuli/specimen.hpp"

#include "support/catch.hpp"

using namespace touchtrial;
using namespace touchtrial::stimuli;

TEST_CASE("the first exemplar is as the recipe says, with the seed's own noise") {
  const Specimen first(7);
  CHECK(first.noise_seed() == 7);
  CHECK(first.shift("depth", 3.0) == 0.0);
  CHECK(first.factor("depth", 0.5) == 1.0);
  CHECK(first.turn("way", 0.5) == Vec2{1.0, 0.0});
  const View view = view_of(first);
  CHECK(view.surface_position(31.5, 8.25) == Vec2{31.5, 8.25});
}

TEST_CASE("further exemplars have other noise and depart within the spread, both ways") {
  bool above = false;
  bool below = false;
  for (int exemplar = 2; exemplar <= 5; ++exemplar) {
    const Specimen specimen(7, exemplar);
    CHECK(specimen.noise_seed() != 7);
    CHECK(specimen.noise_seed() != Specimen(7, exemplar + 1).noise_seed());
    const double factor = specimen.factor("depth", 0.5);
    CHECK(factor >= 1.0 / 1.5);
    CHECK(factor <= 1.5);
    CHECK(factor == Specimen(7, exemplar).factor("depth", 0.5));
    above = above || factor > 1.1;
    below = below || factor < 0.9;
  }
  CHECK(above);
  CHECK(below);
}

TEST_CASE("a view turns, scales and leaves its middle in place") {
  View view{.scale = 2.0, .x_direction = {0.0, 1.0}, .middle = {10.0, 20.0}};
  CHECK(view.surface_position(10.0, 20.0) == Vec2{10.0, 20.0});
  CHECK(view.surface_position(14.0, 20.0) == Vec2{10.0, 22.0});
  CHECK(view.surface_position(10.0, 24.0) == Vec2{8.0, 20.0});
}
