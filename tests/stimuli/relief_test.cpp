#include "stimuli/relief.hpp"

#include "support/catch.hpp"

#include <cmath>

using namespace touchtrial;
using namespace touchtrial::stimuli;

namespace {

Relief level(int size_px) {
  Relief relief(size_px);
  fill(relief, [](double, double) { return SurfacePoint{0.0, 1.0}; });
  return relief;
}

}  // namespace

TEST_CASE("a level surface returns the same light everywhere, as much as light_on_level says") {
  const Lamp lamp;
  const Plane<double> light = render_light(level(12), lamp);
  for (const double value : light.samples()) REQUIRE(value == Approx(light_on_level(lamp)));
}

TEST_CASE("a slope towards the lamp is lighter than one away from it") {
  Lamp lamp{{-1.0, 0.0, 1.0}, 0.0, 10.0, 1.0, 5.0};
  Relief relief(20);
  const auto slope = [&](double rise) {
    fill(relief, [&](double x, double) { return SurfacePoint{rise * x, 1.0}; });
    return render_light(relief, lamp).at(20, 20);
  };
  // The normal of a rise of 1 to the right points straight at the lamp on the left.
  CHECK(slope(1.0) == Approx(1.0));
  CHECK(slope(0.0) == Approx(std::sqrt(0.5)));
  CHECK(slope(-1.0) == Approx(0.0).margin(1e-12));
}

TEST_CASE("a wall casts a shadow of its height away from the lamp") {
  const Lamp lamp{{-1.0, 0.0, 1.0}, 0.0, 30.0, 0.5, 5.0};
  Relief relief(40);
  fill(relief, [](double x, double) {
    return SurfacePoint{x >= 10.0 && x < 12.0 ? 8.0 : 0.0, 1.0};
  });
  const Plane<double> light = render_light(relief, lamp);
  CHECK(light.at(40, kOversampling * 16) == 0.0);
  CHECK(light.at(40, kOversampling * 22) == Approx(std::sqrt(0.5)));
  CHECK(light.at(40, kOversampling * 5) == Approx(std::sqrt(0.5)));
}

TEST_CASE("blurring keeps a constant, the sum far from the edges, and the spread it promises") {
  Plane<double> plane(61, 61);
  plane.at(30, 30) = 1.0;
  const Plane<double> spread = blur(plane, 4);
  double sum = 0.0;
  double variance = 0.0;
  for (int y = 0; y < 61; ++y) {
    for (int x = 0; x < 61; ++x) {
      sum += spread.at(y, x);
      variance += spread.at(y, x) * (x - 30) * (x - 30);
    }
  }
  CHECK(sum == Approx(1.0));
  CHECK(std::sqrt(variance) == Approx(4.5).margin(0.1));
  const Plane<double> constant = blur(Plane<double>(5, 3, 2.5), 4);
  for (const double value : constant.samples()) CHECK(value == Approx(2.5));
}

TEST_CASE("development reaches the wanted mean and keeps the order of light") {
  Plane<double> light(20, 20);
  for (std::size_t i = 0; i < light.size(); ++i) {
    light.samples()[i] = static_cast<double>(i * i);
  }
  const GreyImage picture = develop(light, {120.0});
  double sum = 0.0;
  for (std::size_t i = 0; i < picture.size(); ++i) {
    sum += picture.samples()[i];
    if (i > 0) REQUIRE(picture.samples()[i] >= picture.samples()[i - 1]);
  }
  CHECK(sum / 400 == Approx(120.0).margin(1.0));
}

TEST_CASE("development of an even light, or with nothing that counts, does not fail") {
  CHECK(develop(Plane<double>(4, 4, 0.5), {120.0}).width() == 4);
  CHECK(develop(Plane<double>(4, 4, 0.5), {120.0}, GreyImage(4, 4)).width() == 4);
}
