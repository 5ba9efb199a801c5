#include "device/drivers/falcon/falcon_motors.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::device::falcon {
namespace {

/// The time unit of the motors' heat.
constexpr double kHeatTickS = 0.001;

ThermalBudget budget_of(const FalconSettings& settings) noexcept {
  return {static_cast<double>(settings.motor_peak), static_cast<double>(settings.motor_continuous),
          settings.motor_peak_s, kHeatTickS};
}

}  // namespace

FalconMotors::FalconMotors(const FalconSettings& settings) noexcept
    : max_n_(settings.motor_peak),
      budgets_{budget_of(settings), budget_of(settings), budget_of(settings)} {}

void FalconMotors::warm_until(Time now) noexcept {
  if (begun_) {
    const double ticks = std::chrono::duration<double>(now - sent_at_).count() / kHeatTickS;
    for (std::size_t i = 0; i < 3; ++i) {
      const double value = sent_[i];
      budgets_[i].heat(value * value, std::max(ticks, 0.0));
    }
  }
  begun_ = true;
  sent_at_ = now;
}

MotorCommand FalconMotors::command(const PerLeg& torques_nm, Time now) noexcept {
  warm_until(now);
  sent_ = {};
  double scale = 1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double wanted = std::abs(kMotorValuePerNm * torques_nm[i]);
    if (!std::isfinite(wanted)) return {};
    const double max = std::min(max_n_, budgets_[i].limit_n());
    if (wanted > max) scale = std::min(scale, max / wanted);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const double value = std::round(scale * (kMotorValuePerNm * torques_nm[i]));
    sent_[i] = static_cast<std::int16_t>(std::clamp(value, -max_n_, max_n_));
  }
  return {sent_, scale < 1.0};
}

}  // namespace touchtrial::device::falcon
