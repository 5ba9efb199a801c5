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
    : max_value_(settings.motor_peak),
      budgets_{budget_of(settings), budget_of(settings), budget_of(settings)} {}

void FalconMotors::add_heat_until(Time now) noexcept {
  if (has_sent_) {
    const double ticks = std::chrono::duration<double>(now - sent_at_).count() / kHeatTickS;
    for (std::size_t i = 0; i < 3; ++i) {
      const double value = sent_[i];
      budgets_[i].heat(value * value, std::max(ticks, 0.0));
    }
  }
  has_sent_ = true;
  sent_at_ = now;
}

MotorCommand FalconMotors::command(const PerLeg& torques_nm, Time now) noexcept {
  add_heat_until(now);
  sent_ = {};
  double scale = 1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double requested = std::abs(kMotorValuePerNm * torques_nm[i]);
    if (!std::isfinite(requested)) return {};
    const double max = std::min(max_value_, budgets_[i].limit_n());
    if (requested > max) scale = std::min(scale, max / requested);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const double value = std::round(scale * (kMotorValuePerNm * torques_nm[i]));
    sent_[i] = static_cast<std::int16_t>(std::clamp(value, -max_value_, max_value_));
  }
  return {sent_, scale < 1.0};
}

}  // namespace touchtrial::device::falcon
