#include "device/compensation/force_shaper.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

namespace touchtrial::device {
namespace {

using Response = std::complex<double>;

/// Points of the design's frequency axis around the circle, and taps of a filter: 0.5 s, in which
/// the slowest resonance of a hand has died away.
constexpr std::size_t kDesignPoints = 4096;
constexpr std::size_t kShaperTaps = 512;
/// Above the first a stroke puts next to nothing of a texture, but encoders make noise, so the gain
/// returns to 1 by the second.
constexpr double kShapedToHz = 350.0;
constexpr double kUnshapedFromHz = 450.0;
constexpr double kNS2PerMmOfKg = 0.001;  ///< N s^2/mm

double checked_gain_db(double most_gain_db) {
  if (most_gain_db >= 0.0 && most_gain_db <= kMostGainDb) return most_gain_db;
  throw std::invalid_argument("ForceShaper: the bound of the gain must be in [0, 40] dB");
}

/// \return way of the tip per newton of command, mm/N, without friction and delay
Response way_of_tip(const DeviceModel& device, const HandOnTip& hand, std::size_t axis,
                    double frequency_hz) {
  const Response s(0.0, 2.0 * std::numbers::pi * frequency_hz);
  const Response at_hand = hand.dynamic_stiffness(axis, s);
  const double mass = kNS2PerMmOfKg * device.mass_kg;
  const Response viscous = 0.001 * device.viscous_n_s_per_m * s;
  Response motors = 1.0;
  if (device.lowpass_hz > 0.0) motors /= 1.0 + Response(0.0, frequency_hz / device.lowpass_hz);
  const double k = device.structure.stiffness_n_per_mm;
  if (k == 0.0) return motors / (mass * s * s + viscous + at_hand);
  const double tip = device.structure.tip_share * mass;
  const Response joint = k + 2.0 * device.structure.damping_ratio * std::sqrt(k * tip) * s;
  const Response at_motor = (mass - tip) * s * s + viscous + joint;
  const Response at_tip = tip * s * s + at_hand + joint;
  return motors * joint / (at_motor * at_tip - joint * joint);
}

/// \return the share of the wished gain's logarithm that is wanted at a frequency
double wanted(double frequency_hz) {
  const double u =
      std::clamp((kUnshapedFromHz - frequency_hz) / (kUnshapedFromHz - kShapedToHz), 0.0, 1.0);
  return u * u * (3.0 - 2.0 * u);
}

/// \return the natural logarithm of the gain at points 0 .. kDesignPoints / 2 of the circle
std::vector<double> wished_log_gains(const DeviceModel& device, const HandOnTip& in_device,
                                     const HandOnTip& in_ideal, std::size_t axis, double bound) {
  std::vector<double> logs(kDesignPoints / 2 + 1);
  for (std::size_t i = 1; i < logs.size(); ++i) {
    const double hz = kServoRateHz * static_cast<double>(i) / static_cast<double>(kDesignPoints);
    const double ideal = std::abs(way_of_tip({}, in_ideal, axis, hz));
    const double real = std::abs(way_of_tip(device, in_device, axis, hz));
    logs[i] = wanted(hz) * std::clamp(std::log(ideal / real), -bound, bound);
  }
  logs[0] = 0.0;
  return logs;
}

/// The filter of minimum phase that has these gains: the most of its energy comes first, it is
/// causal, and it needs no poles. Its cepstrum is that of the even gains, folded onto positive
/// times; source: Oppenheim and Schafer, Discrete-Time Signal Processing, homomorphic processing.
std::vector<double> minimum_phase(const std::vector<double>& log_gains) {
  std::vector<double> cosines(kDesignPoints);
  for (std::size_t i = 0; i < kDesignPoints; ++i) {
    cosines[i] = std::cos(2.0 * std::numbers::pi * static_cast<double>(i) /
                          static_cast<double>(kDesignPoints));
  }
  const std::size_t half = kDesignPoints / 2;
  std::vector<double> folded(kShaperTaps);
  for (std::size_t n = 0; n < kShaperTaps; ++n) {
    double sum = log_gains.front() + (n % 2 == 0 ? 1.0 : -1.0) * log_gains.back();
    for (std::size_t i = 1; i < half; ++i) {
      sum += 2.0 * log_gains[i] * cosines[i * n % kDesignPoints];
    }
    folded[n] = (n == 0 ? 1.0 : 2.0) * sum / static_cast<double>(kDesignPoints);
  }
  std::vector<double> taps(kShaperTaps);
  taps[0] = std::exp(folded[0]);
  for (std::size_t n = 1; n < kShaperTaps; ++n) {
    double sum = 0.0;
    for (std::size_t i = 1; i <= n; ++i) sum += static_cast<double>(i) * folded[i] * taps[n - i];
    taps[n] = sum / static_cast<double>(n);
  }
  return taps;
}

/// \return with a gain of exactly 1 at rest
std::vector<double> of_unit_sum(std::vector<double> taps) {
  double sum = 0.0;
  for (const double tap : taps) sum += tap;
  for (double& tap : taps) tap /= sum;
  return taps;
}

}  // namespace

ForceShaper::ForceShaper(const DeviceModel& device, const HandOptions& hand, double most_gain_db)
    : forces_n_(kShaperTaps), max_force_n_(device.max_force_n) {
  check_device_model(device);
  const double bound = checked_gain_db(most_gain_db) * std::numbers::ln10 / 20.0;
  const HandOnTip in_device(hand, device, kServoTickS);
  const HandOnTip in_ideal(hand, {}, kServoTickS);
  for (std::size_t axis = 0; axis < responses_.size(); ++axis) {
    responses_[axis] =
        of_unit_sum(minimum_phase(wished_log_gains(device, in_device, in_ideal, axis, bound)));
  }
}

Vec3 ForceShaper::shaped(Vec3 force_n) noexcept {
  forces_n_[next_] = force_n;
  Vec3 sum_n;
  std::size_t place = next_;
  for (std::size_t i = 0; i < kShaperTaps; ++i) {
    const Vec3& before_n = forces_n_[place];
    sum_n.x += responses_[0][i] * before_n.x;
    sum_n.y += responses_[1][i] * before_n.y;
    sum_n.z += responses_[2][i] * before_n.z;
    place = place == 0 ? kShaperTaps - 1 : place - 1;
  }
  if (++next_ == kShaperTaps) next_ = 0;
  const double magnitude_n = norm(sum_n);
  if (max_force_n_ > 0.0 && magnitude_n > max_force_n_) return (max_force_n_ / magnitude_n) * sum_n;
  return sum_n;
}

void ForceShaper::reset() noexcept {
  std::ranges::fill(forces_n_, Vec3{});
}

double ForceShaper::gain(std::size_t axis, double frequency_hz) const noexcept {
  Response sum;
  const double step = -2.0 * std::numbers::pi * frequency_hz * kServoTickS;
  for (std::size_t i = 0; i < kShaperTaps; ++i) {
    sum += responses_[axis][i] * std::polar(1.0, step * static_cast<double>(i));
  }
  return std::abs(sum);
}

}  // namespace touchtrial::device
