#include "device/calibration/hold.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::device {
namespace {

constexpr double kSpringNPerMm = 0.4;
constexpr double kDamperNSPerMm = 0.008;
constexpr double kIntegralNPerMmS = 1.0;
/// The integral's greatest force: enough for a weight, too little to fight a hand.
constexpr double kMostIntegralN = 3.0;

}  // namespace

Vec3 HoldMeasurement::force_n(const DeviceSample& sample) noexcept {
  if (!sample.ready) {
    holding_ = false;
    return {};
  }
  if (!holding_) {
    holding_ = true;
    place_mm_ = sample.position_mm;
    integral_n_ = {};
  }
  if (mode_ == Mode::rest) return {};
  const Vec3 error_mm = place_mm_ - sample.position_mm;
  integral_n_ = integral_n_ + (kIntegralNPerMmS / rate_hz_) * error_mm;
  const double strength_n = norm(integral_n_);
  if (strength_n > kMostIntegralN) integral_n_ = (kMostIntegralN / strength_n) * integral_n_;
  return kSpringNPerMm * error_mm + integral_n_ - kDamperNSPerMm * sample.velocity_mm_s;
}

void HoldMeasurement::record(const ServoSample& sample) noexcept {
  const double time_s = static_cast<double>(sample.tick) / rate_hz_;
  if (!holding_ || time_s < kSettleS || time_s >= kRunS) return;
  Half& half = halves_[time_s < kSettleS + kMeasureS / 2.0 ? 0 : 1];
  const Vec3 offset_mm = sample.position_mm - place_mm_;
  ++half.ticks;
  half.position_mm = half.position_mm + offset_mm;
  half.force_n = half.force_n + sample.force_n;
  squares_mm2_ += dot(offset_mm, offset_mm);
}

HoldFigures HoldMeasurement::figures() const noexcept {
  const double expected = kMeasureS / 2.0 * rate_hz_;
  HoldFigures figures;
  const auto [fewest, most] = std::minmax(halves_[0].ticks, halves_[1].ticks);
  if (static_cast<double>(fewest) < 0.9 * expected) return figures;
  const auto ticks = static_cast<double>(fewest + most);
  const Vec3 mean_mm = (1.0 / ticks) * (halves_[0].position_mm + halves_[1].position_mm);
  figures.measured = true;
  figures.force_n = (1.0 / ticks) * (halves_[0].force_n + halves_[1].force_n);
  figures.noise_mm = std::sqrt(std::max(squares_mm2_ / ticks - dot(mean_mm, mean_mm), 0.0));
  figures.drift_mm = norm((1.0 / static_cast<double>(halves_[1].ticks)) * halves_[1].position_mm -
                          (1.0 / static_cast<double>(halves_[0].ticks)) * halves_[0].position_mm);
  return figures;
}

}  // namespace touchtrial::device
