#include "core/plane.hpp"

#include "core/plane_geometry.hpp"
#include "support/catch.hpp"

#include <utility>

using namespace touchtrial;

TEST_CASE("a plane is row-major and starts filled") {
  Plane<int> plane(2, 3, 7);
  CHECK(plane.size() == 6);
  CHECK(plane.at(1, 2) == 7);
  plane.at(1, 0) = 4;
  CHECK(plane.samples()[3] == 4);
  CHECK(plane.row(1)[0] == 4);
}

TEST_CASE("a plane with a negative side is refused") {
  CHECK_THROWS_AS(Plane<int>(-1, 3), std::invalid_argument);
  CHECK(Plane<int>(0, 3).empty());
}

TEST_CASE("the mean of a plane is exact for grey levels, and flat planes are recognised") {
  GreyImage image(2, 3, 200);
  CHECK(mean_of(image) == 200.0);
  CHECK(is_flat(image));
  image.at(1, 2) = 203;
  CHECK(mean_of(image) == 200.5);
  CHECK_FALSE(is_flat(image));
}

TEST_CASE("a converted plane has the same samples, and a temporary of the same type is passed on") {
  Plane<float> plane(2, 2, 0.25F);
  const float* const samples = plane.samples().data();
  CHECK(converted<double>(plane) == Plane<double>(2, 2, 0.25));
  const Plane<float> passed = converted<float>(std::move(plane));
  CHECK(passed.samples().data() == samples);
}

TEST_CASE("a pixel's centre lies half a pitch from its edges") {
  const PlaneGeometry geometry{0.2, 500, 400};
  const Vec2 first = geometry.to_mm(0, 0);
  CHECK(first.x == Approx(0.1));
  CHECK(first.y == Approx(0.1));
  const Vec2 back = geometry.to_px(geometry.to_mm(17, 250).x, geometry.to_mm(17, 250).y);
  CHECK(back.x == Approx(17.0));
  CHECK(back.y == Approx(250.0));
  CHECK(geometry.width_mm() == Approx(80.0));
  CHECK(geometry.height_mm() == Approx(100.0));
}

TEST_CASE("the plane contains its edges and nothing beyond") {
  const PlaneGeometry geometry{0.2, 500, 400};
  CHECK(geometry.contains(0.0, 0.0));
  CHECK(geometry.contains(80.0, 100.0));
  CHECK_FALSE(geometry.contains(80.001, 50.0));
  CHECK_FALSE(geometry.contains(-0.001, 50.0));
}
