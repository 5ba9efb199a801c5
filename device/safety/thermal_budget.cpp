#include "device/safety/thermal_budget.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace touchtrial::device {

ThermalBudget::ThermalBudget(const SafetyLimits& limits, double tick_s) noexcept
    : peak_n_(limits.max_force_n),
      continuous_n_(limits.continuous_force_n),
      most_heat_(std::numeric_limits<double>::infinity()) {
  if (!(continuous_n_ > 0.0) || !(continuous_n_ < peak_n_)) return;
  most_heat_ = continuous_n_ * continuous_n_;
  // At peak force the heat is peak^2 (1 - exp(-t / tau)).
  const double warm_share = kWarm * most_heat_ / (peak_n_ * peak_n_);
  tau_s_ = -limits.thermal_budget_s / std::log1p(-warm_share);
  share_per_tick_ = -std::expm1(-tick_s / tau_s_);
}

double ThermalBudget::limit_when_warm_n() const noexcept {
  const double cold = std::max(0.0, 1.0 - heat_ / most_heat_) / (1.0 - kWarm);
  return continuous_n_ + std::min(cold, 1.0) * (peak_n_ - continuous_n_);
}

void ThermalBudget::begin_warm(double heat_n2, double rest_s) noexcept {
  if (share_per_tick_ == 0.0 || !(heat_n2 >= 0.0) || !std::isfinite(heat_n2)) return;
  heat_ = heat_n2 * std::exp(-std::max(rest_s, 0.0) / tau_s_);
}

double ThermalBudget::share_of_heat() const noexcept {
  return heat_ / most_heat_;
}

}  // namespace touchtrial::device
