#include "engine/rendering/cubic_spline.hpp"

#include "engine/rendering/sample_fields.hpp"
#include "engine/symmetric_extension.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial {
namespace {

std::vector<float> rounded(const Plane<double>& plane) {
  std::vector<float> values;
  for (const double value : plane.samples()) values.push_back(static_cast<float>(value));
  return values;
}

/// The cubic B-spline from its definition.
double bspline(double x) {
  const double d = std::abs(x);
  if (d < 1.0) return 2.0 / 3.0 - d * d + 0.5 * d * d * d;
  return d < 2.0 ? (2.0 - d) * (2.0 - d) * (2.0 - d) / 6.0 : 0.0;
}

/// The sum over the mirrored coefficients that can reach a point.
double value_slowly(const Plane<double>& coefficients, double x, double y) {
  double sum = 0.0;
  for (int j = static_cast<int>(std::floor(y)) - 3; j <= std::floor(y) + 4; ++j) {
    for (int i = static_cast<int>(std::floor(x)) - 3; i <= std::floor(x) + 4; ++i) {
      const double c = coefficients.at(engine::symmetric_index(j, coefficients.height()),
                                       engine::symmetric_index(i, coefficients.width()));
      sum += c * bspline(x - i) * bspline(y - j);
    }
  }
  return sum;
}

/// A spline, in single precision as fields have it.
struct Spline {
  explicit Spline(const Plane<double>& samples)
      : exact(engine::cubic_spline_coefficients(samples)), coefficients(rounded(exact)) {}

  [[nodiscard]] engine::PatchSums at(double x, double y) const {
    return engine::spline_at(coefficients, exact.height(), exact.width(), x, y);
  }
  Plane<double> exact;
  std::vector<float> coefficients;
};

TEST_CASE("the spline goes through every sample") {
  const int height = GENERATE(1, 2, 3, 5, 40);
  const int width = GENERATE(1, 2, 4, 70);
  const Plane<double> samples = random_texture(height, width, 1, 100.0);
  const Spline spline(samples);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      CAPTURE(height, width, y, x);
      REQUIRE(value_slowly(spline.exact, x, y) == Approx(samples.at(y, x)).margin(1e-10));
      REQUIRE(spline.at(x, y).value == Approx(samples.at(y, x)).margin(1e-4));
    }
  }
}

TEST_CASE("the spline of a constant plane is that constant, exactly") {
  const double level = GENERATE(0.0, -37.25, 1e-3, 255.0);
  const Plane<double> coefficients = engine::cubic_spline_coefficients(Plane<double>(7, 90, level));
  CHECK(std::ranges::all_of(coefficients.samples(), [&](double c) { return c == level; }));
}

TEST_CASE("spline_at is the sum of B-splines, inside and mirrored beyond the edges") {
  const int height = GENERATE(1, 3, 9);
  const int width = GENERATE(1, 2, 12);
  const Spline spline(random_texture(height, width, 2));
  RandomStream random(3, "points");
  for (int i = 0; i < 300; ++i) {
    const double x = random.uniform(-3.0 * width, 4.0 * width);
    const double y = random.uniform(-3.0 * height, 4.0 * height);
    CAPTURE(height, width, x, y);
    REQUIRE(spline.at(x, y).value == Approx(value_slowly(spline.exact, x, y)).margin(1e-4));
    REQUIRE(spline.at(-1.0 - x, y).value == Approx(spline.at(x, y).value).margin(1e-9));
    REQUIRE(spline.at(x, 2.0 * height - 1.0 - y).value ==
            Approx(spline.at(x, y).value).margin(1e-9));
  }
}

TEST_CASE("the spline's gradient is the slope of its values") {
  const Spline spline(random_texture(12, 15, 4));
  RandomStream random(5, "points");
  constexpr double kStep = 1e-4;
  for (int i = 0; i < 500; ++i) {
    const double x = random.uniform(-4.0, 19.0);
    const double y = random.uniform(-4.0, 16.0);
    const engine::PatchSums point = spline.at(x, y);
    const double along_x = spline.at(x + kStep, y).value - spline.at(x - kStep, y).value;
    const double along_y = spline.at(x, y + kStep).value - spline.at(x, y - kStep).value;
    REQUIRE(point.along_x == Approx(along_x / (2.0 * kStep)).margin(1e-5));
    REQUIRE(point.along_y == Approx(along_y / (2.0 * kStep)).margin(1e-5));
  }
}

TEST_CASE("the spline's curvature is continuous across pixel centres") {
  const Spline spline(random_texture(12, 15, 6));
  constexpr double kStep = 1e-5;
  for (int x = -2; x < 17; ++x) {
    const double before = spline.at(x, 5.3).along_x - spline.at(x - kStep, 5.3).along_x;
    const double behind = spline.at(x + kStep, 5.3).along_x - spline.at(x, 5.3).along_x;
    CAPTURE(x);
    REQUIRE(before / kStep == Approx(behind / kStep).margin(0.05));
  }
}

TEST_CASE("spline_at survives points that no plane has") {
  const Spline spline(random_texture(3, 3, 7));
  for (const double far : {1e9, -1e9, 1e300, -1e300}) {
    CHECK(std::isfinite(spline.at(far, 1.0).value));
    CHECK(std::isfinite(spline.at(1.0, far).along_y));
  }
}

}  // namespace
}  // namespace touchtrial
