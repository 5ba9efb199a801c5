/// \file The part of Force Dimension's DHD library that the driver uses, declared from its public
/// documentation: nothing of the vendor's kit is needed to build. And the thread that talks to a
/// device.
#pragma once

#include "device/device_link.hpp"
#include "device/platform/dynamic_library.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <thread>

namespace touchtrial::device::dhd {

/// Most functions return a number below 0 for an error, 0 for success, 2 if the motors gave less
/// force than requested (no fault), or this one if the call came too soon and gave the same values
/// again.
constexpr int kTimeGuard = 1;

/// The status and places in it. Longer than any version's, so that a newer library stays inside.
using Status = std::array<int, 32>;
constexpr std::size_t kConnected = 1;
constexpr std::size_t kReset = 3;  ///< the device knows where its axes are
constexpr std::size_t kForce = 5;  ///< force is switched on
constexpr std::size_t kError = 9;
constexpr std::size_t kForceOffCause = 14;

/// Causes for which the device itself switches force off; the other causes are a person's act (its
/// button).
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
[[nodiscard]] inline Api load_api(const DynamicLibrary& library) {
  Api api{};
  library.find("dhdGetDeviceCount", api.get_device_count);
  library.find("dhdOpenID", api.open_id);
  library.find("dhdClose", api.close);
  library.find("dhdGetPosition", api.get_position);
  library.find("dhdGetLinearVelocity", api.get_linear_velocity);
  library.find("dhdSetForce", api.set_force);
  library.find("dhdEnableForce", api.enable_force);
  library.find("dhdGetButtonMask", api.get_button_mask);
  library.find("dhdGetStatus", api.get_status);
  library.find("dhdSetTimeGuard", api.set_time_guard);
  library.find("dhdSetGravityCompensation", api.set_gravity_compensation);
  library.find("dhdSetEffectorMass", api.set_effector_mass);
  library.find("dhdErrorGetLastStr", api.error_get_last_str);
  library.find_if_any("dhdEnableExpertMode", api.enable_expert_mode);
  library.find_if_any("dhdDisableExpertMode", api.disable_expert_mode);
  library.find_if_any("dhdGetSystemName", api.get_system_name);
  library.find_if_any("dhdGetSerialNumber", api.get_serial_number);
  library.find_if_any("dhdGetVersion", api.get_version);
  return api;
}

/// About the rate that the device's USB link allows.
constexpr double kPollRateHz = 4000.0;

/// Polls the device from its construction to its destruction, in real time where the system permits
/// it. The last forces that it sends are zeros.
class Loop {
 public:
  /// \param api  must outlive this
  /// \param device  must stay open as long
  Loop(const Api& api, char device);
  ~Loop();
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  [[nodiscard]] DeviceLink& link() noexcept { return link_; }
  [[nodiscard]] DeviceReadiness readiness() const noexcept {
    return readiness_.load(std::memory_order_acquire);
  }

 private:
  void run() noexcept;
  [[nodiscard]] bool may_push() const noexcept {
    return force_on_ && readiness() == DeviceReadiness::ready;
  }
  void tick() noexcept;
  void check_status() noexcept;
  void judge_force_off(int cause) noexcept;
  void take_sample() noexcept;
  void send(Vec3 force_n) noexcept;
  void fail_call() noexcept;

  const Api& api_;
  char device_;
  DeviceLink link_;
  bool force_on_ = false;
  std::int64_t tick_ = 0;
  std::atomic<DeviceReadiness> readiness_{DeviceReadiness::needs_calibration};
  std::atomic<bool> closing_{false};
  std::thread thread_;
};

}  // namespace touchtrial::device::dhd
