/// \file Link of the safety chain: what the motors can take for ever, and for a while.
#pragma once

#include "device/safety/safety_limits.hpp"

namespace touchtrial::device {

/// Motors warm with the square of the force. Their heat is taken as its running mean, which fades
/// exponentially; in those terms, the force that they hold for ever gives the greatest heat there
/// may be. Below kWarm of that the peak force is allowed; from there on the limit falls in
/// proportion, to the continuous force, so that the greatest heat is never passed. The time
/// constant follows from thermal_budget_s: how long a cold motor takes to kWarm at peak force.
/// Nobody has measured it on a device's motors.
class ThermalBudget {
 public:
  static constexpr double kWarm = 0.9;

  /// \param limits  sound; no budget if the continuous force is 0 or the peak does not pass it
  /// \param tick_s  of the servo, > 0
  ThermalBudget(const SafetyLimits& limits, double tick_s) noexcept;

  /// The limit of the force's norm for this tick, N: from the peak down to the continuous force.
  [[nodiscard]] double limit_n() const noexcept {
    if (heat_ <= kWarm * most_heat_) return peak_n_;
    return limit_when_warm_n();
  }

  /// Lets a force work on the motors. \param ticks  >= 0
  void heat(double force_squared_n2, double ticks) noexcept {
    const double share = share_per_tick_ * ticks;
    heat_ += (share < 1.0 ? share : 1.0) * (force_squared_n2 - heat_);
  }

  /// The running mean of the force's square, N^2: what a later budget on the same motors begins
  /// with.
  [[nodiscard]] double heat_n2() const noexcept { return heat_; }
  /// The motors come from earlier work. \param heat_n2  of then, >= 0, finite, else none
  /// \param rest_s  without force since then, >= 0
  void begin_warm(double heat_n2, double rest_s) noexcept;

  /// 0 cold, 1 as hot as may be; 0 without a budget.
  [[nodiscard]] double share_of_heat() const noexcept;

 private:
  [[nodiscard]] double limit_when_warm_n() const noexcept;

  double peak_n_;
  double continuous_n_;
  double most_heat_;             ///< N^2; infinite without a budget
  double tau_s_ = 1.0;           ///< in which heat fades to 1/e
  double share_per_tick_ = 0.0;  ///< of the way to the present force's heat
  double heat_ = 0.0;            ///< N^2
};

}  // namespace touchtrial::device
