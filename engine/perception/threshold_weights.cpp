#include "engine/perception/threshold_weights.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <mutex>
#include <numbers>
#include <stdexcept>
#include <tuple>

namespace touchtrial::engine {
namespace {

constexpr double kLowestHz = 10.0;
constexpr double kMaxRateShare = 0.4;  ///< highest tone, as a share of the rate
constexpr int kReach = 6;              ///< bins to each side over which a sine's power spreads
constexpr int kToneSteps = 4;          ///< tones per bin
constexpr int kIterations = 200;

/// A sine and the shares of its power in the bins around it.
struct Tone {
  int first_bin = 0;
  std::vector<double> shares;
  double target = 0.0;  ///< weight of its total power
};

/// Power of a Hann window's transform at a distance in bins from its peak.
double hann_power(double distance) noexcept {
  constexpr double kTolerance = 1e-6;
  if (std::abs(distance) < kTolerance) return 1.0;
  if (std::abs(std::abs(distance) - 1.0) < kTolerance) return 0.25;
  const double angle = std::numbers::pi * distance;
  const double amplitude = std::sin(angle) / angle / (1.0 - distance * distance);
  return amplitude * amplitude;
}

double weight_at(ThresholdCurve curve, double frequency_hz, double rate_hz) {
  const double clamped_hz = std::max(frequency_hz, kLowestHz);
  const double angular_rate = 2.0 * rate_hz * std::sin(std::numbers::pi * clamped_hz / rate_hz);
  const double peak = angular_rate * angular_rate * threshold_displacement_m(curve, clamped_hz);
  return 1.0 / (0.5 * peak * peak);
}

Tone tone_at(ThresholdCurve curve, double bin, double bin_hz, int bins) {
  const double rate_hz = 2.0 * bins * bin_hz;
  Tone tone;
  tone.first_bin = std::max(1, static_cast<int>(bin) - kReach);
  const int last = std::min(bins, static_cast<int>(bin) + kReach + 1);
  double sum = 0.0;
  for (int k = tone.first_bin; k <= last; ++k) {
    tone.shares.push_back(hann_power(k - bin));
    sum += tone.shares.back();
  }
  for (double& share : tone.shares) share /= sum;
  tone.target = weight_at(curve, bin * bin_hz, rate_hz);
  return tone;
}

/// Starts from the thresholds at the bins' frequencies and iteratively corrects each bin by the
/// tones that it contains.
std::vector<double> weights_for(ThresholdCurve curve, int window, double rate_hz) {
  const double bin_hz = rate_hz / window;
  const int bins = window / 2;
  std::vector<Tone> tones;
  for (double bin = kLowestHz / bin_hz; bin * bin_hz < kMaxRateShare * rate_hz;
       bin += 1.0 / kToneSteps) {
    tones.push_back(tone_at(curve, bin, bin_hz, bins));
  }
  const auto size = static_cast<std::size_t>(bins) + 1;
  std::vector<double> weights(size, 0.0);
  for (int k = 1; k <= bins; ++k) weights[k] = weight_at(curve, k * bin_hz, rate_hz);
  for (int round = 0; round < kIterations; ++round) {
    std::vector<double> correction(size, 0.0), total_share(size, 0.0);
    for (const Tone& tone : tones) {
      double weighted_power = 0.0;
      for (std::size_t i = 0; i < tone.shares.size(); ++i) {
        weighted_power += tone.shares[i] * weights[tone.first_bin + i];
      }
      const double log_error = std::log(tone.target / weighted_power);
      for (std::size_t i = 0; i < tone.shares.size(); ++i) {
        correction[tone.first_bin + i] += tone.shares[i] * log_error;
        total_share[tone.first_bin + i] += tone.shares[i];
      }
    }
    for (std::size_t k = 1; k < size; ++k) {
      constexpr double kMinGain = 0.05;
      if (total_share[k] > kMinGain) weights[k] *= std::exp(correction[k] / total_share[k]);
    }
    // Bins below the lowest tone get the weight of its bin.
    const auto lowest_bin = static_cast<std::size_t>(std::max(1.0, std::floor(kLowestHz / bin_hz)));
    std::fill(weights.begin() + 1, weights.begin() + static_cast<std::ptrdiff_t>(lowest_bin),
              weights[lowest_bin]);
  }
  return weights;
}

}  // namespace

const std::vector<double>& threshold_weights(ThresholdCurve curve, int window, double rate_hz) {
  constexpr int kMinWindow = 64;
  constexpr int kMaxWindow = 1 << 16;
  constexpr double kMinRateHz = 100.0;
  if (window < kMinWindow || window > kMaxWindow || window % 2 != 0 || !(rate_hz >= kMinRateHz) ||
      !std::isfinite(rate_hz)) {
    throw std::invalid_argument("threshold_weights: window or rate is out of range");
  }
  static std::mutex mutex;
  static std::map<std::tuple<ThresholdCurve, int, double>, std::vector<double>> cache;
  const std::lock_guard lock(mutex);
  std::vector<double>& weights = cache[{curve, window, rate_hz}];
  if (weights.empty()) weights = weights_for(curve, window, rate_hz);
  return weights;
}

}  // namespace touchtrial::engine
