// Every function that takes real numbers from callers refuses NaN and infinity with a clear error.
#include "core/errors.hpp"
#include "engine/extraction.hpp"
#include "engine/gaussian_filter.hpp"
#include "engine/rendering/texture_field.hpp"
#include "engine/stability/extreme_cases.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"

#include <functional>
#include <limits>
#include <vector>

namespace touchtrial {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
const std::vector<double> kNotFinite = {kNan, kInfinity, -kInfinity};

/// Calls check with planes of zeros except for one sample, which takes every place.
template <typename Real>
void with_each_sample(double value, const std::function<void(const Plane<Real>&)>& check) {
  Plane<Real> plane(4, 5);
  for (Real& sample : plane.samples()) {
    sample = static_cast<Real>(value);
    check(plane);
    sample = Real{0};
  }
}

TEMPLATE_TEST_CASE("a plane with one sample that is not finite is refused by name", "", float,
                   double) {
  for (const double value : kNotFinite) {
    with_each_sample<TestType>(value, [](const Plane<TestType>& plane) {
      CHECK_THAT(
          message_of<std::invalid_argument>([&] { (void)engine::tangential_force(plane, 3); }),
          names("tangential_force"));
      CHECK_THAT(message_of<std::invalid_argument>([&] { (void)engine::texture_picture(plane); }),
                 names("texture_picture"));
      CHECK_THAT(message_of<std::invalid_argument>(
                     [&] { (void)engine::texture_picture(plane, engine::Mapping::stretch); }),
                 names("texture_picture"));
    });
  }
}

TEST_CASE("a field of a texture that is not finite is refused by name") {
  for (const double value : kNotFinite) {
    with_each_sample<double>(value, [](const Plane<double>& plane) {
      CHECK_THAT(
          message_of<std::invalid_argument>([&] { (void)engine::make_texture_field(plane, {}); }),
          names("make_texture_field"));
      CHECK_THAT(
          message_of<std::invalid_argument>([&] { (void)engine::gaussian_filtered(plane, 2.0); }),
          names("gaussian_filtered"));
    });
  }
}

}  // namespace
}  // namespace touchtrial
