#include "engine/extraction.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

namespace touchtrial {
namespace {

template <typename Real>
int picture_of(Real texture) {
  return engine::texture_picture(Plane<Real>(1, 1, texture)).at(0, 0);
}

TEMPLATE_TEST_CASE("texture_picture rounds ties upwards, never to even", "", float, double) {
  CHECK(picture_of<TestType>(TestType(0.5)) == 129);
  CHECK(picture_of<TestType>(TestType(1.5)) == 130);
  CHECK(picture_of<TestType>(TestType(-0.5)) == 128);
  CHECK(picture_of<TestType>(TestType(-1.5)) == 127);
}

TEMPLATE_TEST_CASE("texture_picture clamps to what eight bits hold", "", float, double) {
  CHECK(picture_of<TestType>(TestType(-128.6)) == 0);
  CHECK(picture_of<TestType>(TestType(-1000)) == 0);
  CHECK(picture_of<TestType>(TestType(127)) == 255);
  CHECK(picture_of<TestType>(TestType(127.5)) == 255);
  CHECK(picture_of<TestType>(std::numeric_limits<TestType>::max()) == 255);
  CHECK(picture_of<TestType>(std::numeric_limits<TestType>::lowest()) == 0);
}

TEST_CASE("texture_picture does not round a float twice") {
  CHECK(picture_of(std::nextafter(0.5F, 0.0F)) == 128);
  CHECK(picture_of(std::nextafter(-0.5F, -1.0F)) == 127);
}

TEMPLATE_TEST_CASE("the mapping abs shows magnitudes, rounded half up", "", float, double) {
  Plane<TestType> texture(1, 4);
  texture.at(0, 0) = TestType(-3.5);
  texture.at(0, 1) = TestType(2.25);
  texture.at(0, 2) = TestType(-400);
  const GreyImage picture = engine::texture_picture(texture, engine::Mapping::abs);
  CHECK(picture.at(0, 0) == 4);
  CHECK(picture.at(0, 1) == 2);
  CHECK(picture.at(0, 2) == 255);
  CHECK(picture.at(0, 3) == 0);
}

TEMPLATE_TEST_CASE("the mapping stretch fills 0 to 255, and shows a flat texture as 0", "", float,
                   double) {
  Plane<TestType> texture(1, 3);
  texture.at(0, 0) = TestType(-1);
  texture.at(0, 1) = TestType(1);
  texture.at(0, 2) = TestType(4);
  const GreyImage picture = engine::texture_picture(texture, engine::Mapping::stretch);
  CHECK(picture.at(0, 0) == 0);
  CHECK(picture.at(0, 1) == 102);
  CHECK(picture.at(0, 2) == 255);
  CHECK(engine::texture_picture(Plane<TestType>(2, 3, TestType(7)), engine::Mapping::stretch) ==
        GreyImage(2, 3));
}

TEMPLATE_TEST_CASE("texture_surface adds mid-grey and rounds nothing", "", float, double) {
  const Plane<TestType> surface = engine::texture_surface(Plane<TestType>(2, 3, TestType(-200.25)));
  REQUIRE(surface.height() == 2);
  REQUIRE(surface.width() == 3);
  for (const TestType sample : surface.samples()) CHECK(sample == TestType(-72.25));
}

TEST_CASE("texture_picture and texture_surface refuse an empty texture") {
  CHECK_THROWS_AS(engine::texture_picture(Plane<float>()), std::invalid_argument);
  CHECK_THROWS_AS(engine::texture_surface(Plane<double>()), std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial
