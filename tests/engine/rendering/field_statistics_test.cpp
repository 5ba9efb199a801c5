#include "engine/rendering/field_statistics.hpp"

#include "engine/rendering/field_measures.hpp"
#include "engine/rendering/gains.hpp"
#include "engine/rendering/sample_fields.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace touchtrial {
namespace {

using namespace engine;

constexpr double kTurn = 2.0 * std::numbers::pi;

/// A wave of whole cycles across a plane.
struct Wave {
  double amplitude;
  int cycles_x;
  int cycles_y;
};

/// Samples whose force along x is a sum of waves on a 100 x 100 plane of 20 mm.
std::vector<FieldSample> waves(std::initializer_list<Wave> parts, double mean = 0.0) {
  std::vector<FieldSample> samples(100 * 100);
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 100; ++x) {
      double force = mean;
      for (const Wave& wave : parts) {
        force += wave.amplitude * std::cos(kTurn * (wave.cycles_x * x + wave.cycles_y * y) / 100.0);
      }
      samples[static_cast<std::size_t>(y) * 100 + x].force_x = static_cast<float>(force);
    }
  }
  return samples;
}

/// The statistics of the lateral force of these samples.
FieldStatistics statistics_of(const std::vector<FieldSample>& samples, double n_per_grey = 1.0) {
  return engine::lateral_statistics({{0.2, 100, 100}, samples}, n_per_grey);
}

/// Share of power above a limit, from the discrete Fourier transform's definition.
double share_slowly(const std::array<const Plane<double>*, 2>& components, double limit) {
  const int height = components[0]->height();
  const int width = components[0]->width();
  double above = 0.0;
  double total = 0.0;
  for (const Plane<double>* plane : components) {
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        if (u == 0 && v == 0) continue;
        std::complex<double> sum = 0.0;
        for (int y = 0; y < height; ++y) {
          for (int x = 0; x < width; ++x) {
            const double turns =
                static_cast<double>(u * x) / width + static_cast<double>(v * y) / height;
            sum += plane->at(y, x) * std::polar(1.0, -kTurn * turns);
          }
        }
        const double fx = std::min(u, width - u) / static_cast<double>(width);
        const double fy = std::min(v, height - v) / static_cast<double>(height);
        total += std::norm(sum);
        if (std::hypot(fx, fy) > limit) above += std::norm(sum);
      }
    }
  }
  return above / total;
}

TEST_CASE("power_shares_above agrees with the transform written out, on even and odd sizes") {
  const int height = GENERATE(1, 5, 6);
  const int width = GENERATE(4, 7);
  const auto in_single = [](const Plane<double>& plane) {
    return converted<double>(converted<float>(plane));
  };
  const Plane<double> x = in_single(random_texture(height, width, 1));
  const Plane<double> y = in_single(random_texture(height, width, 2, 15.0));
  std::vector<FieldSample> samples;
  for (std::size_t i = 0; i < x.size(); ++i) {
    samples.push_back(
        {0.0F, static_cast<float>(x.samples()[i]), static_cast<float>(y.samples()[i])});
  }
  const std::vector<double> limits = {0.6, 0.0, 0.19, 0.31, 0.45, 1.0};
  const std::vector<double> shares =
      engine::power_shares_above({{0.2, height, width}, samples}, limits);
  for (std::size_t i = 0; i < limits.size(); ++i) {
    CAPTURE(height, width, limits[i]);
    CHECK(shares[i] == Approx(share_slowly({&x, &y}, limits[i])).margin(1e-12));
  }
  CHECK(shares[1] == Approx(1.0).epsilon(1e-12));
  CHECK(shares[5] == 0.0);
}

TEST_CASE("power_shares_above is zero for a constant field") {
  const std::vector<FieldSample> constant(8 * 9, {0.0F, 3.25F, 3.25F});
  CHECK(engine::power_shares_above({{0.2, 8, 9}, constant}, std::vector<double>{0.0}) ==
        std::vector<double>{0.0});
}

TEST_CASE("field_statistics gives the rms of a wave and of the heights in newtons") {
  CHECK(statistics_of(waves({{2.0, 5, 0}}), 0.01).tangential_rms_n ==
        Approx(0.01 * 2.0 / std::sqrt(2.0)).epsilon(1e-6));
  std::vector<float> heights(100 * 100);
  for (std::size_t i = 0; i < heights.size(); ++i) heights[i] = i % 2 == 0 ? 3.0F : -3.0F;
  const FieldStatistics statistics =
      engine::field_statistics(view_of_heights(heights, 100, 100), {0.01, 0.02});
  CHECK(statistics.normal_rms_n == Approx(0.02 * 3.0).epsilon(1e-12));
}

TEST_CASE("field_statistics counts the power of waves shorter than a millimetre") {
  // 20 cycles across 20 mm are exactly 1 mm, which is not below it.
  CHECK(statistics_of(waves({{1.0, 20, 0}})).share_below_1_mm == Approx(0.0).margin(1e-9));
  CHECK(statistics_of(waves({{1.0, 0, 21}})).share_below_1_mm == Approx(1.0).epsilon(1e-9));
  // 15 and 15 cycles make a wave of 21.2 cycles along the diagonal.
  CHECK(statistics_of(waves({{1.0, 15, 15}})).share_below_1_mm == Approx(1.0).epsilon(1e-9));
  const auto mixed = waves({{std::sqrt(3.0), 10, 3}, {1.0, 30, 7}}, 5.0);
  CHECK(statistics_of(mixed).share_below_1_mm == Approx(0.25).epsilon(1e-6));
}

TEST_CASE("field_statistics counts the power over 250 Hz at each stroke speed") {
  // 1.5 cycles/mm are felt at 75, 150 and 300 Hz; 3 cycles/mm at 150, 300 and 600 Hz.
  const auto slow = statistics_of(waves({{1.0, 30, 0}}));
  CHECK(slow.share_above_250_hz[0] == Approx(0.0).margin(1e-9));
  CHECK(slow.share_above_250_hz[1] == Approx(0.0).margin(1e-9));
  CHECK(slow.share_above_250_hz[2] == Approx(1.0).epsilon(1e-9));
  const auto both = statistics_of(waves({{1.0, 30, 0}, {1.0, 35, 49}}));
  CHECK(both.share_above_250_hz[0] == Approx(0.0).margin(1e-9));
  CHECK(both.share_above_250_hz[1] == Approx(0.5).epsilon(1e-6));
  CHECK(both.share_above_250_hz[2] == Approx(1.0).epsilon(1e-9));
}

TEST_CASE("field_statistics does not change its shares with the gain") {
  const TextureField field = random_field(31, 44, 3);
  const FieldStatistics weak = engine::field_statistics(field.view(), {0.001, 0.0});
  const FieldStatistics strong = engine::field_statistics(field.view(), {0.1, 0.0});
  CHECK(weak.share_below_1_mm > 0.0);
  CHECK(weak.share_below_1_mm == strong.share_below_1_mm);
  CHECK(strong.tangential_rms_n == Approx(100.0 * weak.tangential_rms_n).epsilon(1e-12));
}

TEST_CASE("field_statistics finds the 99.9th percentile of the force") {
  std::vector<FieldSample> samples(2001);
  for (int i = 0; i <= 2000; ++i) samples[i].force_y = static_cast<float>((i * 7) % 2001);
  const FieldStatistics statistics = engine::lateral_statistics({{0.2, 3, 667}, samples}, 0.5);
  CHECK(statistics.tangential_p999_n == Approx(0.5 * 1998.0).epsilon(1e-12));
}

TEST_CASE("field_statistics finds the budget in the stiffness of a field that has it alone") {
  const TextureField field = random_field(50, 60, 4);
  const FieldView view = field.view();
  const StudyGains gains = engine::choose_gains({&view, 1}, {});
  CHECK(engine::field_statistics(view, gains.per_field[0]).stiffness_p99_n_per_mm ==
        Approx(0.4).epsilon(1e-9));
}

TEST_CASE("field_statistics is zero throughout for a flat field of any size") {
  const int side = GENERATE(1, 2, 16);
  const FieldStatistics statistics =
      engine::field_statistics(flat_field(side, side).view(), {1.0, 1.0});
  CHECK(statistics.tangential_rms_n == 0.0);
  CHECK(statistics.tangential_p999_n == 0.0);
  CHECK(statistics.normal_rms_n == 0.0);
  CHECK(statistics.stiffness_p99_n_per_mm == 0.0);
  CHECK(statistics.share_below_1_mm == 0.0);
  CHECK(statistics.share_above_250_hz == std::array{0.0, 0.0, 0.0});
}

TEST_CASE("field_statistics refuses an empty field and samples that are not finite") {
  CHECK_THROWS_AS(engine::field_statistics({}, {}), std::invalid_argument);
  std::vector<float> heights(9);
  heights[4] = std::numeric_limits<float>::infinity();
  CHECK_THROWS_AS(engine::field_statistics(view_of_heights(heights, 3, 3), {}),
                  std::invalid_argument);
}

TEST_CASE("the lateral field of either model has the rms that its statistics state") {
  const Plane<double> texture = random_texture(24, 31, 1);
  for (const ModelKind model : {ModelKind::paper, ModelKind::surface}) {
    RenderingOptions options{.model = model};
    const TextureField field = engine::make_texture_field(texture, options);
    const Gains gains = model == ModelKind::paper ? Gains{0.01, 0.02, 0.0} : Gains{0.0, 0.0, 0.003};
    const LateralField lateral = lateral_field(field.view(), gains);
    double squares = 0.0;
    for (std::size_t i = 0; i < texture.size(); ++i) {
      squares +=
          std::pow(lateral.force.x.samples()[i], 2) + std::pow(lateral.force.y.samples()[i], 2);
    }
    const double rms_n =
        lateral.n_per_grey * std::sqrt(squares / static_cast<double>(texture.size()));
    CHECK(rms_n > 0.0);
    CHECK(rms_n == Approx(engine::field_statistics(field.view(), gains, options).tangential_rms_n));
  }
}

TEST_CASE("an empty field has no lateral field") {
  CHECK_THROWS_AS((void)lateral_field(FieldView{}, Gains{}), std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial
