/// \file Converts torques to a Falcon's motor values, within each motor's range and thermal limit.
///
/// A force may load a single motor, so the safety chain's limit of the force's norm does not
/// protect a motor; here each motor has its own limit. A limit scales all three motors by the same
/// factor, which preserves the force's direction.
///
/// Belongs to the driver's thread; nothing here allocates, locks or throws.
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
/// programs use other values (docs/devices/falcon.md). Not verified on hardware.
inline constexpr double kMotorValuePerNm = -6616.0;

/// The minimum force per motor value over the workspace and all directions, N. It occurs at the
/// edge of the workspace; at the centre the force is 1.85 mN.
inline constexpr double kForcePerMotorValueN = 1.59e-3;

/// A command to the motors.
struct MotorCommand {
  MotorValues values{};
  bool limited = false;  ///< whether the values are below the requested torques
};

class FalconMotors {
 public:
  using Time = std::chrono::nanoseconds;

  explicit FalconMotors(const FalconSettings& settings) noexcept;

  /// Begins a command. The previous one is assumed to have been active until now.
  /// \param now  not earlier than in the last call
  /// \return values within every limit; zeros, not limited, if a torque is not finite
  [[nodiscard]] MotorCommand command(const PerLeg& torques_nm, Time now) noexcept;

 private:
  void add_heat_until(Time now) noexcept;

  double max_value_;
  std::array<ThermalBudget, 3> budgets_;
  MotorValues sent_{};
  Time sent_at_{};
  bool has_sent_ = false;
};

}  // namespace touchtrial::device::falcon
