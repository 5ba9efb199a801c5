/// \file The part of Force Dimension's DHD library that the driver uses, declared from its public
/// documentation: nothing of the vendor's kit is needed to build.
#pragma once

#include "device/platform/dynamic_library.hpp"

#include <array>
#include <cstddef>

namespace touchtrial::device::dhd {

/// What most functions return: below 0 an error, 0 done, 2 that the motors gave less force than was
/// asked for, which is no fault, or this: asked too soon, so the values are those of before.
constexpr int kTimeGuard = 1;

/// Places in the status. Longer than any version's, so that a newer library stays inside.
using Status = std::array<int, 32>;
constexpr std::size_t kConnected = 1;
constexpr std::size_t kReset = 3;  ///< the device knows where its axes are
constexpr std::size_t kForce = 5;  ///< force is switched on
constexpr std::size_t kError = 9;
constexpr std::size_t kForceOffCause = 14;

/// Causes for which the device itself switches force off; the others are a person's (its button).
constexpr int kOffByVelocity = 2;
constexpr int kOffByWatchdog = 3;
constexpr int kOffByUnplugging = 5;

constexpr int kRecommendedTimeGuard = -1;

/// The functions, dhdGetDeviceCount as get_device_count and so on. The last argument is the device.
struct Api {
  int (*get_device_count)();
  int (*open_id)(char);
  int (*close)(char);
  int (*get_position)(double*, double*, double*, char);         ///< m
  int (*get_linear_velocity)(double*, double*, double*, char);  ///< m/s
  int (*set_force)(double, double, double, char);               ///< N
  int (*enable_force)(unsigned char, char);
  unsigned (*get_button_mask)(char);
  int (*get_status)(int*, char);
  int (*set_time_guard)(int, char);
  int (*set_gravity_compensation)(int, char);
  int (*set_effector_mass)(double, char);  ///< kg
  const char* (*error_get_last_str)();

  /// \name Null where the library does not have them
  ///@{
  int (*enable_expert_mode)();
  int (*disable_expert_mode)();
  const char* (*get_system_name)(char);
  int (*get_serial_number)(unsigned short*, char);
  int (*get_version)(double*, char);
  ///@}
};

/// \throws DeviceError if a function is missing
[[nodiscard]] Api load_api(const DynamicLibrary& library);

}  // namespace touchtrial::device::dhd
