#include "engine/perception/texture_sense.hpp"

#include "core/random.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace touchtrial {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRateHz = 1000.0;
constexpr int kSettling = 501;  // the landing sample and half a second after it
constexpr double kPushN = 0.7;

struct Felt {
  Vec3 position_mm;
  Vec3 force_n;
};

/// A steady stroke along x over a force that depends on the place: the landing, then `samples`
/// samples.
template <typename ForceAt>
std::vector<Felt> stroke(double speed_mm_s, int samples, ForceAt force_at) {
  std::vector<Felt> felt;
  for (int i = 0; i < kSettling + samples; ++i) {
    const double x_mm = speed_mm_s * i / kRateHz;
    felt.push_back({{x_mm, 20.0, -1.7}, Vec3{0.0, 0.0, kPushN} + force_at(x_mm)});
  }
  return felt;
}

engine::FeltFeatures features_of(const std::vector<Felt>& samples, double threshold_n = 0.0) {
  engine::TextureSense sense({.rate_hz = kRateHz, .threshold_n = threshold_n});
  for (const Felt& sample : samples) sense.feel(sample.position_mm, sample.force_n);
  return sense.features();
}

std::vector<Felt> noisy_stroke(std::uint64_t seed, double scale) {
  RandomStream random(seed, "texture_sense_test");
  return stroke(110.0, 2048, [&](double) {
    const Vec3 force{random.normal(), random.normal(), random.normal()};
    return (scale * 0.05) * force;
  });
}

TEST_CASE("a sine is felt in the band of its wavelength, with its root mean square") {
  const int band = GENERATE(0, 1, 2, 3, 4);
  const double speed_mm_s = GENERATE(80.0, 100.0);
  const double wavelength_mm = engine::kMaxFeltMm / std::exp2(band + 0.5);
  constexpr double kAmplitudeN = 0.1;
  const auto felt = stroke(speed_mm_s, 4096, [&](double x_mm) {
    const double wave = kAmplitudeN * std::sin(2.0 * kPi * x_mm / wavelength_mm);
    return Vec3{wave, 0.0, 0.5 * wave};
  });
  const engine::FeltFeatures features = features_of(felt, 1e-6);
  const double log_rms = std::log(kAmplitudeN / std::sqrt(2.0));
  // A window holds few of the longest waves, and some of their power leaks out of the band.
  const double tolerance = band == 0 ? 0.25 : 0.03;
  CHECK(features[band] == Approx(log_rms).margin(tolerance));
  CHECK(features[engine::kNormalBandsAt + band] ==
        Approx(log_rms - std::log(2.0)).margin(tolerance));
  for (int other = 0; other < engine::kFeltBands; ++other) {
    if (std::abs(other - band) > 1) CHECK(features[other] < log_rms - 3.0);
  }
}

TEST_CASE("a lateral force is felt along its own direction") {
  const int along = GENERATE(0, 1, 2, 3);
  const double angle = kPi / 4.0 * along;
  const auto felt = stroke(100.0, 4096, [&](double x_mm) {
    const double wave = 0.1 * std::sin(2.0 * kPi * x_mm / 1.5);
    return Vec3{wave * std::cos(angle), wave * std::sin(angle), 0.0};
  });
  const engine::FeltFeatures features = features_of(felt, 1e-6);
  const double log_rms = std::log(0.1 / std::sqrt(2.0));
  const auto direction = [&](int i) {
    return features[engine::kDirectionsAt + i % engine::kFeltDirections];
  };
  CHECK(direction(along) == Approx(log_rms).margin(0.03));
  CHECK(direction(along + 1) == Approx(log_rms - 0.5 * std::log(2.0)).margin(0.03));
  CHECK(direction(along + 2) < log_rms - 5.0);
}

TEST_CASE("a texture is felt on the part of the plane where it is") {
  constexpr PlaneGeometry kPlane{0.2, 300, 450};  // thirds of 30 mm across, 20 mm down
  engine::TextureSense sense({.threshold_n = 1e-6, .plane = kPlane});
  for (int i = 0; i < kSettling + 60'000; ++i) {
    // Strokes to and fro along x, stepping slowly down; waves on the right third of the plane.
    const double phase = std::fmod(0.1 * i, 180.0);
    const double x_mm = phase < 90.0 ? phase : 180.0 - phase;
    const double wave = x_mm > 60.0 ? 0.1 * std::sin(2.0 * kPi * x_mm / 1.5) : 0.0;
    sense.feel({x_mm, 0.001 * i, -1.0}, {wave, 0.0, kPushN});
  }
  const engine::FeltFeatures features = sense.features();
  for (int row = 0; row < 3; ++row) {
    const int part = engine::kPartsAt + 3 * row;
    CHECK(features[part + 2] == Approx(std::log(0.1 / std::sqrt(2.0))).margin(0.2));
    CHECK(features[part + 1] < features[part + 2] - 1.0);
    CHECK(features[part] < features[part + 2] - 5.0);
  }
}

TEST_CASE("an unexplored part of the plane feels like the whole") {
  const engine::FeltFeatures features = features_of(noisy_stroke(2, 1.0));
  CHECK(features[engine::kPartsAt + engine::kFeltParts - 1] ==
        Approx(0.5 * std::log(std::exp(2.0 * features[engine::kDirectionsAt]) +
                              std::exp(2.0 * features[engine::kDirectionsAt + 2]))));
}

TEST_CASE("forces twice as strong add ln 2 to every feature") {
  const engine::FeltFeatures once = features_of(noisy_stroke(1, 1.0));
  const engine::FeltFeatures twice = features_of(noisy_stroke(1, 2.0));
  for (int i = 0; i < engine::kFeltFeatures; ++i) {
    CHECK(twice[i] - once[i] == Approx(std::log(2.0)).margin(1e-5));
  }
}

/// One-sided power of every bin of one window, by the definition of the transform.
std::vector<double> slow_periodogram(const std::vector<double>& window) {
  const auto n = static_cast<int>(window.size());
  double mean = 0.0;
  for (const double sample : window) mean += sample / n;
  std::vector<double> power(n / 2 + 1, 0.0);
  for (int k = 1; k <= n / 2; ++k) {
    std::complex<double> sum;
    for (int i = 0; i < n; ++i) {
      const double hann = 0.5 - 0.5 * std::cos(2.0 * kPi * i / n);
      sum += hann * (window[i] - mean) * std::polar(1.0, -2.0 * kPi * k * i / n);
    }
    power[k] = std::norm(sum) * 2.0 / (n * 0.375 * n);
  }
  return power;
}

/// Power between two frequencies in bins, where bin k is spread evenly over k - 1/2 .. k + 1/2.
double power_between(const std::vector<double>& power, double low, double high) {
  double sum = 0.0;
  for (std::size_t k = 1; k < power.size(); ++k) {
    const double overlap =
        std::min(high, static_cast<double>(k) + 0.5) - std::max(low, static_cast<double>(k) - 0.5);
    sum += power[k] * std::max(0.0, overlap);
  }
  return sum;
}

TEST_CASE("felt bands agree with a slow Welch estimate") {
  const std::vector<Felt> felt = noisy_stroke(7, 1.0);
  const engine::FeltFeatures features = features_of(felt);
  std::vector<double> expected(engine::kFeltBands, 0.0);
  int windows = 0;
  for (std::size_t first = kSettling; first + 256 <= felt.size(); first += 128) {
    std::vector<double> window;
    for (std::size_t i = 0; i < 256; ++i) window.push_back(felt[first + i].force_n.z);
    const std::vector<double> power = slow_periodogram(window);
    for (int band = 0; band < engine::kFeltBands; ++band) {
      const double low = 110.0 / engine::kMaxFeltMm * std::exp2(band) * 256.0 / kRateHz;
      expected[band] += power_between(power, low, 2.0 * low);
    }
    ++windows;
  }
  for (int band = 0; band < engine::kFeltBands; ++band) {
    const double log_rms = 0.5 * std::log(expected[band] / windows);
    CHECK(features[engine::kNormalBandsAt + band] == Approx(log_rms).margin(1e-4));
  }
}

TEST_CASE("what is felt without contact, at rest or while landing does not count") {
  engine::TextureSense sense;
  for (int i = 0; i < 2000; ++i) sense.feel({0.1 * i, 0.0, 3.0}, {});
  CHECK(sense.windows() == 0);
  for (int i = 0; i < 500; ++i) sense.feel({0.1 * i, 0.0, -1.0}, {0.0, 0.0, 0.7});
  CHECK(sense.windows() == 0);
  for (int i = 0; i < 1000; ++i) sense.feel({5.0, 0.0, -1.0}, {0.0, 0.0, 0.7});
  CHECK(sense.windows() == 0);
  for (int i = 0; i < 1000; ++i) sense.feel({0.1 * i, 0.0, -1.0}, {0.0, 0.0, 0.7});
  CHECK(sense.windows() > 5);
}

TEST_CASE("a smooth plane and nothing felt at all leave every feature at the threshold") {
  constexpr double kThresholdN = 0.002;
  const auto smooth = stroke(100.0, 2000, [](double) { return Vec3{}; });
  for (const double feature : features_of(smooth, kThresholdN)) {
    CHECK(feature == Approx(std::log(kThresholdN)).margin(1e-9));
  }
  for (const double feature : engine::TextureSense().features()) {
    CHECK(feature == Approx(std::log(kThresholdN)).margin(1e-12));
  }
}

TEST_CASE("a sense after a reset feels like a new one") {
  engine::TextureSense used;
  for (const Felt& sample : noisy_stroke(3, 2.0)) used.feel(sample.position_mm, sample.force_n);
  used.reset(engine::SenseOptions{}.plane);
  CHECK(used.windows() == 0);
  for (const Felt& sample : noisy_stroke(4, 1.0)) used.feel(sample.position_mm, sample.force_n);
  CHECK(used.features() == features_of(noisy_stroke(4, 1.0), engine::SenseOptions{}.threshold_n));
}

TEST_CASE("a sense refuses impossible options") {
  CHECK_THROWS_AS(engine::TextureSense({.rate_hz = 0.0}), std::invalid_argument);
  CHECK_THROWS_AS(engine::TextureSense({.threshold_n = -0.1}), std::invalid_argument);
  CHECK_THROWS_AS(engine::TextureSense({.plane = {0.2, 0, 10}}), std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial
