/// \file Limits how long motors may exceed their continuous force. The safety chain has one budget
/// for the force's norm; a driver may have one for each motor. Source: docs/safety.md.
///
/// A budget belongs to one thread; nothing here allocates, locks or throws.
#pragma once

#include "device/safety/safety_limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace touchtrial::device {

/// Limits the force by the motors' heat, which is modelled as the exponentially weighted mean of
/// the squared force. The maximum heat is the square of the continuous force. Below the share kWarm
/// of it the peak force is allowed; above, the limit falls linearly to the continuous force, so
/// that the maximum is never exceeded. The time constant is derived from the time in which the peak
/// force warms a cold motor to kWarm; it has not been measured on real motors.
///
/// "Force" is any quantity proportional to the motors' current: newtons, or a motor command.
class ThermalBudget {
 public:
  static constexpr double kWarm = 0.9;

  /// \param peak,continuous  in the unit of the force, finite; no budget unless
  ///   0 < continuous < peak
  /// \param peak_s  how long a cold motor may exert the peak force before the limit falls, > 0
  /// \param tick_s  the unit of time of `heat`, > 0
  ThermalBudget(double peak, double continuous, double peak_s, double tick_s) noexcept
      : peak_(peak), continuous_(continuous) {
    if (!(continuous_ > 0.0) || !(continuous_ < peak_)) return;
    max_heat_ = continuous_ * continuous_;
    // At peak force the heat is peak^2 (1 - exp(-t / tau)).
    const double warm_share = kWarm * max_heat_ / (peak_ * peak_);
    tau_s_ = -peak_s / std::log1p(-warm_share);
    share_per_tick_ = -std::expm1(-tick_s / tau_s_);
  }
  /// \param limits  valid; no budget if the continuous force is 0 or not below the peak force
  /// \param tick_s  of the servo, > 0
  ThermalBudget(const SafetyLimits& limits, double tick_s) noexcept
      : ThermalBudget(limits.max_force_n, limits.continuous_force_n, limits.thermal_budget_s,
                      tick_s) {}

  /// \param support_n  force that the motors exert in addition to the limited one, >= 0
  /// \return the limit of the force's norm for this tick: from the peak force down to the continuous
  ///   force minus the support
  [[nodiscard]] double limit_n(double support_n = 0.0) const noexcept {
    if (heat_ <= kWarm * max_heat_) return peak_;
    const double cold_share = std::max(0.0, 1.0 - heat_ / max_heat_) / (1.0 - kWarm);
    const double sustained_n = std::max(0.0, continuous_ - support_n);
    return sustained_n + std::min(cold_share, 1.0) * (peak_ - sustained_n);
  }

  /// Warms the motors by a force.
  /// \param ticks  how long the force was sent, >= 0
  void heat(double force_squared_n2, double ticks) noexcept {
    if (share_per_tick_ == 0.0) return;  // no budget
    heat_ += std::min(1.0, share_per_tick_ * ticks) * (force_squared_n2 - heat_);
  }

  /// \return the running mean of the force's square, N^2, for `begin_warm` of a later run on the
  ///   same motors; 0 without a budget
  [[nodiscard]] double heat_n2() const noexcept { return heat_; }
  /// Starts with motors that are warm from earlier runs.
  /// \param heat_n2  when the last run ended; a value that is negative or not finite is ignored
  /// \param rest_s  without force since then, >= 0
  void begin_warm(double heat_n2, double rest_s) noexcept {
    if (share_per_tick_ == 0.0 || !(heat_n2 >= 0.0) || !std::isfinite(heat_n2)) return;
    heat_ = heat_n2 * std::exp(-std::max(rest_s, 0.0) / tau_s_);
  }

 private:
  double peak_;
  double continuous_;
  double max_heat_ = std::numeric_limits<double>::infinity();  ///< infinite: no budget
  double tau_s_ = 1.0;                                         ///< in which heat fades to 1/e
  double share_per_tick_ = 0.0;  ///< of the approach to the current force's heat
  double heat_ = 0.0;            ///< the force's square
};

}  // namespace touchtrial::device
