// Rendering for extreme textures, gains and hand movements.
#include "engine/extraction.hpp"
#include "engine/rendering/field_statistics.hpp"
#include "engine/rendering/gains.hpp"
#include "engine/rendering/paper_model.hpp"
#include "engine/stability/extreme_cases.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <limits>
#include <vector>

namespace touchtrial {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

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
  engine::RenderingOptions options{.damping_n_s_per_mm = 0.01,
                                   .touchdown_ramp_n = GENERATE(0.0, 1e-320, 1e-9, 0.2, 1.0)};
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
        engine::RenderingOptions options{.texture_stiffness_n_per_mm = budget,
                                         .touchdown_ramp_n = ramp_n};
        const engine::Gains gains = engine::choose_gains(views, options).per_field.front();
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
