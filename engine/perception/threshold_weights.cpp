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
constexpr double kMaxRateShare = 0.4;  ///< of the rate
constexpr int kReach = 6;              ///< bins to each side over which a sine's power spreads
constexpr int kToneSteps = 4;          ///< tones to a bin
constexpr int kRounds = 200;

/// A tone, and the shares of its power in the bins around it.
struct Tone {
  int first = 0;  ///< bin
  std::vector<double> shares;
  double wanted = 0.0;  ///< weight of its whole power
};

/// Power of a Hann window's transform, `apart` bins from its middle.
double hann_power(double apart) noexcept {
  constexpr double kNear = 1e-6;
  if (std::abs(apart) < kNear) return 1.0;
  if (std::abs(std::abs(apart) - 1.0) < kNear) return 0.25;
  const double turn = std::numbers::pi * apart;
  const double amplitude = std::sin(turn) / turn / (1.0 - apart * apart);
  return amplitude * amplitude;
}

double weight_at(ThresholdCurve curve, double frequency_hz, double rate_hz) {
  const double heard_hz = std::max(frequency_hz, kLowestHz);
  const double turn = 2.0 * rate_hz * std::sin(std::numbers::pi * heard_hz / rate_hz);
  const double peak = turn * turn * threshold_displacement_m(curve, heard_hz);
  return 1.0 / (0.5 * peak * peak);
}

Tone tone_at(ThresholdCurve curve, double place, double bin_hz, int bins) {
  const double rate_hz = 2.0 * bins * bin_hz;
  Tone tone;
  tone.first = std::max(1, static_cast<int>(place) - kReach);
  const int last = std::min(bins, static_cast<int>(place) + kReach + 1);
  double sum = 0.0;
  for (int k = tone.first; k <= last; ++k) {
    tone.shares.push_back(hann_power(k - place));
    sum += tone.shares.back();
  }
  for (double& share : tone.shares) share /= sum;
  tone.wanted = weight_at(curve, place * bin_hz, rate_hz);
  return tone;
}

/// Starts from the bins' own thresholds and iteratively corrects every bin by the tones that it
/// contains.
std::vector<double> weights_for(ThresholdCurve curve, int window, double rate_hz) {
  const double bin_hz = rate_hz / window;
  const int bins = window / 2;
  std::vector<Tone> tones;
  for (double place = kLowestHz / bin_hz; place * bin_hz < kMaxRateShare * rate_hz;
       place += 1.0 / kToneSteps) {
    tones.push_back(tone_at(curve, place, bin_hz, bins));
  }
  const auto size = static_cast<std::size_t>(bins) + 1;
  std::vector<double> weights(size, 0.0);
  for (int k = 1; k <= bins; ++k) weights[k] = weight_at(curve, k * bin_hz, rate_hz);
  for (int round = 0; round < kRounds; ++round) {
    std::vector<double> correction(size, 0.0), heard(size, 0.0);
    for (const Tone& tone : tones) {
      double found = 0.0;
      for (std::size_t i = 0; i < tone.shares.size(); ++i) {
        found += tone.shares[i] * weights[tone.first + i];
      }
      const double missing = std::log(tone.wanted / found);
      for (std::size_t i = 0; i < tone.shares.size(); ++i) {
        correction[tone.first + i] += tone.shares[i] * missing;
        heard[tone.first + i] += tone.shares[i];
      }
    }
    for (std::size_t k = 1; k < size; ++k) {
      constexpr double kMinGain = 0.05;
      if (heard[k] > kMinGain) weights[k] *= std::exp(correction[k] / heard[k]);
    }
    // Lower frequencies count as the lowest one.
    const auto lowest = static_cast<std::size_t>(std::max(1.0, std::floor(kLowestHz / bin_hz)));
    std::fill(weights.begin() + 1, weights.begin() + static_cast<std::ptrdiff_t>(lowest),
              weights[lowest]);
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
  static std::map<std::tuple<ThresholdCurve, int, double>, std::vector<double>> known;
  const std::lock_guard lock(mutex);
  std::vector<double>& weights = known[{curve, window, rate_hz}];
  if (weights.empty()) weights = weights_for(curve, window, rate_hz);
  return weights;
}

}  // namespace touchtrial::engine
