// Whether the window shows enough to tell coarse textures apart: docs/devices/mouse.md.
#include "device/drivers/mouse/path_observer.hpp"
#include "support/catch.hpp"

#include <memory>

namespace touchtrial {
namespace {

constexpr int kStrokes = 40;

TextureMaker gratings(std::vector<Grating> of_texture) {
  return [of_texture = std::move(of_texture)](std::size_t index) {
    return std::make_unique<Grating>(of_texture[index]);
  };
}

TEST_CASE(
    "the observer also names gratings and strokes that did not serve to choose the settings") {
  const auto held_out = [](std::vector<Grating> pair) {
    const TextureMaker make = gratings(std::move(pair));
    return share_named_rightly(2, kStrokes, {make, 500'000}, {make, 900'000});
  };
  CHECK(held_out({{3.0, 0.04}, {5.0, 0.04}}) >= 0.9);
  CHECK(held_out({{5.0, 0.04}, {8.0, 0.04}}) >= 0.9);
  CHECK(held_out({{6.0, 0.04}, {7.5, 0.04}}) >= 0.9);
  CHECK(held_out({{6.0, 0.04}, {6.0, 0.06}}) >= 0.9);
}

TEST_CASE("an observer of the drawn path guesses if the two textures are the same") {
  const double right = share_named_rightly(2, kStrokes, gratings({{5.0, 0.05}, {5.0, 0.05}}));
  CHECK(right == 0.5);
}

TEST_CASE("without displacement there is nothing to see, and the observer guesses") {
  device::MouseOptions stiff{.pull_n_per_mm = 100.0};
  const double right =
      share_named_rightly(2, kStrokes, gratings({{4.0, 0.05}, {7.0, 0.05}}), stiff);
  CHECK(right > 0.3);
  CHECK(right < 0.7);
}

}  // namespace
}  // namespace touchtrial
