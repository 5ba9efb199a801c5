// Every function that takes real numbers from callers refuses NaN and infinity with a clear error.
#include "core/errors.hpp"
#include "engine/extraction.hpp"
#include "engine/gaussian_filter.hpp"
#include "engine/refusal.hpp"
#include "engine/rendering/field_statistics.hpp"
#include "engine/rendering/gains.hpp"
#include "engine/stability/extreme_cases.hpp"
#include "support/catch.hpp"

#include <functional>
#include <limits>
#include <string>
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
      CHECK(refusal_of([&] { (void)engine::tangential_force(plane, 3); }) ==
            "tangential_force: the surface has samples that are not finite");
      CHECK(refusal_of([&] { (void)engine::texture_picture(plane); }) ==
            "texture_picture: the texture has samples that are not finite");
      CHECK(refusal_of([&] { (void)engine::texture_picture(plane, engine::Mapping::stretch); }) ==
            "texture_picture: the texture has samples that are not finite");
    });
  }
}

TEST_CASE("a field of a texture that is not finite is refused by name") {
  for (const double value : kNotFinite) {
    with_each_sample<double>(value, [](const Plane<double>& plane) {
      CHECK(refusal_of([&] { (void)engine::make_texture_field(plane, {}); }) ==
            "make_texture_field: the texture has samples that are not finite");
      CHECK(refusal_of([&] { (void)engine::gaussian_filtered(plane, 2.0); }) ==
            "gaussian_filtered: the plane has samples that are not finite");
    });
  }
}

TEST_CASE("an option that is not finite is refused by its name, whatever the method") {
  const GreyImage image = noise_image({9, 9});
  const auto refusal = [&](engine::Method method,
                           const std::function<void(engine::ExtractionOptions&)>& spoil) {
    engine::ExtractionOptions options;
    options.method = method;
    spoil(options);
    return refusal_of([&] { (void)engine::extract_texture<float>(image, options); });
  };
  for (const double value : kNotFinite) {
    CHECK_THAT(refusal(engine::Method::fixed, [=](auto& o) { o.order = value; }),
               holds_text("order:"));
    CHECK_THAT(refusal(engine::Method::gaussian, [=](auto& o) { o.sigma_px = value; }),
               holds_text("sigma:"));
    CHECK_THAT(refusal(engine::Method::median, [=](auto& o) { o.threshold_grey = value; }),
               holds_text("threshold:"));
    CHECK_THAT(refusal(engine::Method::edge, [=](auto& o) { o.divisor = value; }),
               holds_text("divisor:"));
    CHECK_THAT(refusal(engine::Method::tv_gabor, [=](auto& o) { o.tv_gabor.lambda = value; }),
               holds_text("lambda:"));
    CHECK_THAT(refusal(engine::Method::tv_gabor, [=](auto& o) { o.tv_gabor.gap = value; }),
               holds_text("gap:"));
  }
}

TEST_CASE("orders of 1 and beyond, and below 0, are refused before anything is computed") {
  for (const double order : {1.0, -1.0, -1e-300, 1.0 + 1e-15, 1e300, kNan, kInfinity}) {
    engine::ExtractionOptions options;
    options.method = engine::Method::fixed;
    options.order = order;
    CHECK_THAT(refusal_of([&] { engine::check_options(options); }),
               holds_text("order: must be in [0, 1), not "));
  }
}

TEST_CASE("rendering options that are not finite are refused") {
  const engine::TextureField field = engine::make_texture_field(Plane<double>(5, 5, 1.0), {});
  const std::vector<engine::FieldView> views = {field.view()};
  for (const double value : kNotFinite) {
    engine::RenderingOptions options;
    options.pitch_mm = value;
    CHECK_FALSE(refusal_of([&] {
                  (void)engine::make_texture_field(Plane<double>(5, 5), options);
                }).empty());
    options = {};
    options.filter_mm = value;
    CHECK_FALSE(refusal_of([&] {
                  (void)engine::make_texture_field(Plane<double>(5, 5), options);
                }).empty());
    options = {};
    options.texture_stiffness_n_per_mm = value;
    CHECK_FALSE(refusal_of([&] { (void)engine::choose_gains(views, options); }).empty());
    for (const engine::Gains gains : {engine::Gains{value, 0.1}, engine::Gains{0.1, value}}) {
      options = {};
      options.gains = gains;
      CHECK(refusal_of([&] { (void)engine::choose_gains(views, options); }) ==
            "choose_gains: explicit gains must be finite numbers >= 0");
    }
  }
}

}  // namespace
}  // namespace touchtrial
