// Tangential force and rendering for extreme textures, gains and hand movements.
#include "engine/extraction.hpp"
#include "engine/finite_plane.hpp"
#include "engine/plane_comparison.hpp"
#include "engine/rendering/field_statistics.hpp"
#include "engine/rendering/gains.hpp"
#include "engine/rendering/paper_model.hpp"
#include "engine/stability/extreme_cases.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <vector>

namespace touchtrial {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <typename Real>
Real sobel_x(const Plane<Real>& g, int y, int x) {
  return g.at(y - 1, x + 1) + 2 * g.at(y, x + 1) + g.at(y + 1, x + 1) - g.at(y - 1, x - 1) -
         2 * g.at(y, x - 1) - g.at(y + 1, x - 1);
}
template <typename Real>
Real sobel_y(const Plane<Real>& g, int y, int x) {
  return g.at(y + 1, x - 1) + 2 * g.at(y + 1, x) + g.at(y + 1, x + 1) - g.at(y - 1, x - 1) -
         2 * g.at(y - 1, x) - g.at(y - 1, x + 1);
}

/// The largest difference of the force inside from half of minus the Sobel gradient of the texture.
template <typename Real>
double error_inside(const engine::Extraction<Real>& result) {
  const Plane<Real>& texture = result.texture;
  double error = 0.0;
  for (int y = 1; y + 1 < texture.height(); ++y) {
    for (int x = 1; x + 1 < texture.width(); ++x) {
      const double error_x = result.force.x.at(y, x) + 0.5 * sobel_x(texture, y, x);
      const double error_y = result.force.y.at(y, x) + 0.5 * sobel_y(texture, y, x);
      error = std::max({error, std::abs(error_x), std::abs(error_y)});
    }
  }
  return error;
}

/// The force from the existing neighbours alone.
template <typename Real>
double force_x_at(const Plane<Real>& g, int y, int x) {
  double force = 0.0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (const int dx : {-1, 1}) {
      const bool exists = y + dy >= 0 && y + dy < g.height() && x + dx >= 0 && x + dx < g.width();
      if (!exists) continue;
      force += (static_cast<double>(g.at(y, x)) - g.at(y + dy, x + dx)) * dx / (dx * dx + dy * dy);
    }
  }
  return force;
}

template <typename Real>
double error_in_first_row(const engine::Extraction<Real>& result) {
  double error = 0.0;
  for (int x = 0; x < result.texture.width(); ++x) {
    error = std::max(error, std::abs(result.force.x.at(0, x) - force_x_at(result.texture, 0, x)));
  }
  return error;
}

TEST_CASE(
    "the force of every extreme texture is half of minus its Sobel gradient, "
    "one-sided at the border") {
  engine::WantedPlanes wanted;
  wanted.force = true;
  for_every_extreme([&]<typename Real>(const ExtractionCase& extraction, const GreyImage& image) {
    const auto result = engine::extract_texture<Real>(image, extraction.options, wanted);
    const double digits = std::is_same_v<Real, float> ? 1e-6 : 1e-14;
    const double tolerance = digits * 8.0 * std::max(1.0, largest_magnitude(result.texture));
    REQUIRE(error_inside(result) <= tolerance);
    REQUIRE(error_in_first_row(result) <= tolerance);
  });
}

engine::TextureField field_of(const GreyImage& image) {
  return engine::make_texture_field(engine::extract_texture<double>(image, {}).texture, {});
}

/// Positions and velocities that no hand has, but that a broken device may report.
const std::vector<Vec3>& wild_vectors() {
  static const std::vector<Vec3> vectors = {
      {0, 0, 0},          {1, 1, -0.5},       {-1e300, 1e300, -1e300},
      {3.3, 3.4, 1e-300}, {kNan, 1, -1},      {1, kNan, -1},
      {1, 1, kNan},       {kInfinity, 0, -1}, {0, -kInfinity, 0},
      {1, 1, -kInfinity}, {6.6, 7.0, -1e12},  {1e-320, 1e-320, -1e-320}};
  return vectors;
}

TEST_CASE("the paper model's force is finite and limited for gains from 1e-12 to 1e12") {
  const engine::TextureField field = field_of(noise_image({33, 35}));
  engine::RenderingOptions options;
  options.damping_n_s_per_mm = 0.01;
  options.touchdown_ramp_n = GENERATE(0.0, 1e-320, 1e-9, 0.2, 1.0);
  for (double gain = 1e-12; gain < 2e12; gain *= 1e3) {
    for (const engine::Gains gains :
         {engine::Gains{gain, 0.0}, engine::Gains{0.0, gain}, engine::Gains{gain, gain}}) {
      const engine::PaperModel model(field.view(), options, gains);
      for (const Vec3 position_mm : wild_vectors()) {
        for (const Vec3 velocity_mm_s : wild_vectors()) {
          const Vec3 force_n = model.force_n(position_mm, velocity_mm_s);
          REQUIRE(is_finite(force_n));
          REQUIRE(norm(force_n) <= options.max_force_n * (1.0 + 1e-12));
        }
      }
    }
  }
}

TEST_CASE("gains of extreme textures are finite, and those of flat ones are zero") {
  const double ramp_n = GENERATE(0.0, 1e-320, 0.2);
  for (const Size size : extreme_sizes()) {
    for (const auto& [name, image] : extreme_images(size)) {
      INFO(name << ", " << size.height << " x " << size.width);
      const engine::TextureField field = field_of(image);
      const std::vector<engine::FieldView> views = {field.view()};
      for (const double budget : {1e-12, 0.4, 1e12}) {
        engine::RenderingOptions options;
        options.texture_stiffness_n_per_mm = budget;
        options.touchdown_ramp_n = ramp_n;
        const engine::Gains gains = engine::choose_gains(views, options).of_field.front();
        CHECK(std::isfinite(gains.tangential_n));
        CHECK(std::isfinite(gains.normal_n));
        CHECK(gains.tangential_n >= 0.0);
        CHECK(gains.normal_n >= 0.0);
        const engine::FieldStatistics statistics =
            engine::field_statistics(field.view(), gains, options);
        CHECK(std::isfinite(statistics.stiffness_p99_n_per_mm));
        CHECK(std::isfinite(statistics.tangential_p999_n));
        CHECK(statistics.share_below_1_mm >= 0.0);
        CHECK(statistics.share_below_1_mm <= 1.0 + 1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace touchtrial
