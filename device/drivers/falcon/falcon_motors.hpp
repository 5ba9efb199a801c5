/// \file What a Falcon's motors are asked for: torques as motor values, within the range of every
/// motor and within what it can hold without getting too warm.
///
/// A force may load one motor alone, so the safety chain's limits of the force's norm cannot see
/// how hard a motor works. Here each has its own. A limit shortens all three motors by one factor,
/// so that the force keeps its direction.
///
/// Belongs to the driver's own thread; nothing here allocates, locks or throws.
#pragma once

#include "device/device_settings.hpp"
#include "device/drivers/falcon/falcon_kinematics.hpp"
#include "device/drivers/falcon/falcon_packet.hpp"
#include "device/safety/thermal_budget.hpp"

#include <array>
#include <chrono>

namespace touchtrial::device::falcon {

/// The motor value of a torque, N m, at an arm. Source: S. Martin and N. Hillier, "Characterisation
/// of the Novint Falcon haptic device for application as a robot manipulator", ACRA 2009. Other
/// programs have other numbers (docs/devices/falcon.md). Not verified on hardware.
inline constexpr double kMotorValuePerNm = -6616.0;

/// The force that one unit of motor value gives at least, at every place of the workspace and in
/// every direction, N. The least is at its edge; at the centre it is 1.85 mN.
inline constexpr double kForcePerMotorValueN = 1.59e-3;

/// What goes to the motors.
struct MotorCommand {
  MotorValues values{};
  bool limited = false;  ///< less than the torques asked for
};

class FalconMotors {
 public:
  using Time = std::chrono::nanoseconds;

  explicit FalconMotors(const FalconSettings& settings) noexcept;

  /// Begins a command; the one before it counts as sent until now.
  /// \param now  never earlier than in the last call
  /// \return values within every limit; zeros, not limited, if a torque is not finite
  [[nodiscard]] MotorCommand command(const PerLeg& torques_nm, Time now) noexcept;

 private:
  void warm_until(Time now) noexcept;

  double most_;
  std::array<ThermalBudget, 3> budgets_;
  MotorValues sent_{};
  Time sent_at_{};
  bool begun_ = false;
};

}  // namespace touchtrial::device::falcon
