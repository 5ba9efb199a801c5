// Sines through a spectrum that is computed here by the definition, against the published curves.
#include "engine/perception/threshold_weights.hpp"

#include "support/catch.hpp"

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace touchtrial {
namespace {

using engine::ThresholdCurve;

/// One-sided powers of a window's bins: a Hann window and a discrete Fourier transform, term by
/// term.
std::vector<double> powers_of(const std::vector<double>& samples) {
  const auto n = static_cast<int>(samples.size());
  std::vector<double> powers(static_cast<std::size_t>(n / 2) + 1);
  for (int k = 0; k <= n / 2; ++k) {
    std::complex<double> sum;
    for (int i = 0; i < n; ++i) {
      const double hann = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * i / n);
      sum += hann * samples[i] * std::polar(1.0, -2.0 * std::numbers::pi * i * k / n);
    }
    powers[k] = 2.0 / (n * 0.375 * n) * std::norm(sum);
  }
  return powers;
}

/// What a sine of the threshold's amplitude counts for, on average over its phase.
double counted(ThresholdCurve curve, double frequency_hz) {
  constexpr int kWindow = 256;
  constexpr int kPhases = 5;
  const std::vector<double>& weights = engine::threshold_weights(curve, kWindow, 1000.0);
  const double peak_m = engine::threshold_displacement_m(curve, frequency_hz);
  double sum = 0.0;
  for (int phase = 0; phase < kPhases; ++phase) {
    const auto place_m = [&](int i) {
      const double turns = frequency_hz * i / 1000.0 + static_cast<double>(phase) / kPhases;
      return peak_m * std::sin(2.0 * std::numbers::pi * turns);
    };
    std::vector<double> samples;
    for (int i = 0; i < kWindow; ++i) {
      samples.push_back((place_m(i + 1) - 2.0 * place_m(i) + place_m(i - 1)) * 1e6);
    }
    const std::vector<double> powers = powers_of(samples);
    for (std::size_t k = 1; k < powers.size(); ++k) sum += weights[k] * powers[k];
  }
  return sum / kPhases;
}

}  // namespace

TEST_CASE("a sine at a curve's threshold counts as one threshold at any frequency") {
  const ThresholdCurve curve = GENERATE(ThresholdCurve::israr_2006, ThresholdCurve::tan_1994);
  double worst_db = 0.0;
  for (double frequency_hz = 10.0; frequency_hz <= 400.0; frequency_hz *= 1.013) {
    const double level_db = 10.0 * std::log10(counted(curve, frequency_hz));
    INFO(frequency_hz << " Hz: " << level_db << " dB");
    CHECK(std::abs(level_db) < 0.5);
    worst_db = std::max(worst_db, std::abs(level_db));
  }
  INFO(worst_db);
  CHECK(worst_db > 0.0);
}

TEST_CASE("the published thresholds are met at their frequencies") {
  const auto level_db = [](ThresholdCurve curve, double frequency_hz) {
    return 20.0 * std::log10(engine::threshold_displacement_m(curve, frequency_hz) / 1e-6);
  };
  const double published[7][3] = {{10, 28.3, 28}, {20, 18.6, 28},   {40, 4.5, 23},
                                  {80, -9.6, 11}, {160, -23.7, -1}, {320, -24.4, -12},
                                  {500, -18, -12}};
  for (const auto& [frequency_hz, israr_db, tan_db] : published) {
    CHECK(level_db(ThresholdCurve::israr_2006, frequency_hz) == Approx(israr_db).margin(1e-9));
    CHECK(level_db(ThresholdCurve::tan_1994, frequency_hz) == Approx(tan_db).margin(0.2));
  }
  // The rule of thumb of the first: about 0.1 m/s^2 peak from 10 to 160 Hz.
  for (const double frequency_hz : {10.0, 20.0, 40.0, 80.0, 160.0}) {
    const double angular = 2.0 * std::numbers::pi * frequency_hz;
    const double peak = angular * angular *
                        engine::threshold_displacement_m(ThresholdCurve::israr_2006, frequency_hz);
    CHECK(peak > 0.06);
    CHECK(peak < 0.14);
  }
}

TEST_CASE("weights for impossible windows and rates are refused") {
  const auto weights = [](int window, double rate_hz) {
    static_cast<void>(engine::threshold_weights(ThresholdCurve::tan_1994, window, rate_hz));
  };
  CHECK_THROWS_AS(weights(0, 1000.0), std::invalid_argument);
  CHECK_THROWS_AS(weights(255, 1000.0), std::invalid_argument);
  CHECK_THROWS_AS(weights(1 << 17, 1000.0), std::invalid_argument);
  CHECK_THROWS_AS(weights(256, 0.0), std::invalid_argument);
  CHECK_THROWS_AS(weights(256, std::numeric_limits<double>::infinity()), std::invalid_argument);
  CHECK_NOTHROW(weights(64, 100.0));
}

}  // namespace touchtrial
