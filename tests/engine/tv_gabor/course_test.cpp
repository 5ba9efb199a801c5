#include "engine/example_images.hpp"
#include "engine/plane_comparison.hpp"
#include "engine/reference/tv_gabor_course.hpp"
#include "engine/reference/tv_gabor_reference.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <stdexcept>
#include <type_traits>

namespace touchtrial {
namespace {

using reference::TvGaborAlgorithm;
using reference::TvGaborCourse;
using reference::TvGaborPoint;

constexpr TvGaborAlgorithm kAlgorithms[] = {TvGaborAlgorithm::admm, TvGaborAlgorithm::fixed_point};

template <typename Real>
TvGaborPoint<Real> after(const GreyImage& image, TvGaborAlgorithm algorithm, int steps) {
  TvGaborCourse<Real> course(image, {}, algorithm);
  course.advance(steps);
  return course.point();
}

TEMPLATE_TEST_CASE("all TV-Gabor solvers reach one texture", "", float, double) {
  const GreyImage image = noise_image({12, 15});
  const auto expected = after<double>(image, TvGaborAlgorithm::admm, 1500).texture;
  CHECK(distance_relative_to(after<TestType>(image, TvGaborAlgorithm::admm, 200).texture,
                             expected) < 1e-3);
  CHECK(distance_relative_to(after<TestType>(image, TvGaborAlgorithm::fixed_point, 4000).texture,
                             expected) < 1e-2);
}

TEMPLATE_TEST_CASE("gaps of TV-Gabor solvers are never negative and shrink overall", "", float,
                   double) {
  for (const TvGaborAlgorithm algorithm : kAlgorithms) {
    TvGaborCourse<TestType> course(cloth_image({40, 33}), {}, algorithm);
    double last = 100.0;
    for (const int steps : {0, 20, 60, 200}) {
      course.advance(steps);
      const double gap = course.point().gap;
      CHECK(gap >= 0.0);
      CHECK(gap < last);
      last = gap;
    }
    CHECK(course.point().steps == 280);
  }
}

TEST_CASE("the fixed point on the engine's transforms takes the steps that define it") {
  const GreyImage image = cloth_image({6, 9});
  const reference::TvGabor definition(image, {});
  const Plane<double> expected = definition.cropped(definition.texture(definition.fixed_point(30)));
  const auto found = after<double>(image, TvGaborAlgorithm::fixed_point, 30).texture;
  CHECK(distance_relative_to(found, expected) < 1e-9);
}

TEST_CASE("looking at a TV-Gabor course does not change it") {
  for (const TvGaborAlgorithm algorithm : kAlgorithms) {
    const GreyImage image = noise_image({10, 11});
    TvGaborCourse<double> watched(image, {}, algorithm);
    watched.advance(20);
    CHECK(watched.point().gap == watched.point().gap);
    watched.advance(20);
    TvGaborCourse<double> alone(image, {}, algorithm);
    alone.advance(20);
    alone.advance(20);
    CHECK(watched.point().texture == alone.point().texture);
  }
}

TEST_CASE("a TV-Gabor course of a flat or empty image is refused") {
  CHECK_THROWS_AS(TvGaborCourse<float>(flat_image({4, 4}, 9), {}, TvGaborAlgorithm::fixed_point),
                  std::invalid_argument);
  CHECK_THROWS_AS(TvGaborCourse<float>(GreyImage(), {}, TvGaborAlgorithm::admm),
                  std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial
