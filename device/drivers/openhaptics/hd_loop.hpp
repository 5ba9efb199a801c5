/// \file The callback that the vendor's scheduler thread runs once per tick. The functions of the
///   OpenHaptics device API (HDAPI) that the driver uses are declared here from the public
///   documentation, so that a build does not need the vendor's SDK.
#pragma once

#include "device/drivers/device_link.hpp"
#include "device/haptic_device.hpp"
#include "device/platform/dynamic_library.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>

namespace touchtrial::device::hd {

using Handle = std::uint32_t;  ///< HHD: a device
using Enum = std::uint32_t;
using ScheduleHandle = unsigned long;  ///< a scheduled callback
using Callback = std::uint32_t(void*);

/// The top of the library's stack of errors, passed by value.
struct ErrorInfo {
  std::uint32_t code;
  int internal_code;
  Handle device;
};

constexpr Handle kInvalidHandle = 0xFFFFFFFF;
constexpr std::uint32_t kCallbackDone = 0;
constexpr std::uint32_t kCallbackContinue = 1;
/// Runs before every other callback of the scheduler.
constexpr std::uint16_t kHighestPriority = 0xFFFF;

/// Parameters to read and write.
constexpr Enum kButtons = 0x2000;
constexpr Enum kPosition = 0x2050;  ///< 3 doubles, mm
constexpr Enum kVelocity = 0x2051;  ///< 3 doubles, mm/s
constexpr Enum kVersion = 0x2500;   ///< of the library
constexpr Enum kModel = 0x2501;
constexpr Enum kVendor = 0x2503;
constexpr Enum kSerial = 0x2504;
constexpr Enum kFirmware = 0x2505;
constexpr Enum kMaxWorkspace = 0x2550;     ///< 6 doubles, mm: min x, y, z, max x, y, z
constexpr Enum kUsableWorkspace = 0x2551;  ///< the same, limited to reliable forces
constexpr Enum kCalibrationStyles = 0x2555;
constexpr Enum kMaxStiffness = 0x2602;      ///< nominal, N/mm
constexpr Enum kMaxForce = 0x2603;          ///< nominal, N
constexpr Enum kContinuousForce = 0x2604;   ///< nominal, N
constexpr Enum kMotorTemperature = 0x2605;  ///< 6 doubles: 0 cold, 1 maximum
constexpr Enum kMaxDamping = 0x2609;        ///< nominal, N s/mm
constexpr Enum kCurrentForce = 0x2700;      ///< 3 doubles, N

/// Capabilities to switch on and off.
constexpr Enum kForceOutput = 0x4000;
constexpr Enum kForceClamping = 0x4001;
constexpr Enum kForceRamping = 0x4002;

/// States of calibration, and bits of its styles.
constexpr Enum kCalibrationOk = 0x5000;
constexpr Enum kCalibrationNeedsUpdate = 0x5001;
constexpr int kStyleEncoderReset = 1;  ///< a person confirms that the arm is at a known position
constexpr int kStyleAuto = 2;          ///< the device calibrates itself while it is moved
constexpr int kStyleInkwell = 4;       ///< the stylus is in its inkwell

/// Errors with a specific DeviceFault; all others are DeviceFault::driver.
constexpr std::uint32_t kWarmMotors = 0x200;
constexpr std::uint32_t kExceededForce = 0x201;
constexpr std::uint32_t kExceededImpulse = 0x202;
constexpr std::uint32_t kExceededVelocity = 0x203;
constexpr std::uint32_t kCommunicationError = 0x302;

/// The library's functions: init_device is hdInitDevice, and so on.
struct Api {
  Handle (*init_device)(const char*);
  void (*disable_device)(Handle);
  void (*make_current_device)(Handle);
  void (*begin_frame)(Handle);
  void (*end_frame)(Handle);
  void (*enable)(Enum);
  void (*disable)(Enum);
  void (*get_doublev)(Enum, double*);
  void (*get_integerv)(Enum, int*);
  void (*set_doublev)(Enum, const double*);
  const char* (*get_string)(Enum);
  const char* (*get_error_string)(std::uint32_t);
  ErrorInfo (*get_error)();
  Enum (*check_calibration)();
  void (*update_calibration)(Enum);
  void (*start_scheduler)();
  void (*stop_scheduler)();
  void (*set_scheduler_rate)(unsigned long);
  ScheduleHandle (*schedule_asynchronous)(Callback*, void*, std::uint16_t);
  void (*unschedule)(ScheduleHandle);
};

/// \throws DeviceError if a function is missing
[[nodiscard]] Api load_api(const DynamicLibrary& library);

/// The summary of a drained error stack.
struct Errors {
  std::uint32_t oldest = 0;  ///< code; 0: no error
  /// The most specific error: a warm motor rather than the resulting failed frame.
  DeviceFault fault = DeviceFault::none;
};

/// Pops all errors, without heap, lock or I/O in this function.
[[nodiscard]] Errors drain_errors(const Api& api) noexcept;

/// The device's capabilities, queried when it was opened.
struct LoopOptions {
  bool has_motor_temperature = false;
  int calibration_style = kStyleInkwell;  ///< one of the styles; 0: unknown
};

/// The callback and all data that it uses. Created and destroyed on the thread that opens the
/// device.
class Loop {
 public:
  /// The limit, on the vendor's scale from 0 (cold) to 1 (maximum). The library raises an error at
  /// 1; the driver stops before that, while the motors still follow commands.
  static constexpr double kMaxMotorTemperature = 0.95;

  Loop(const Api& api, Handle device, const LoopOptions& options) noexcept
      : api_(api), device_(device), options_(options) {}

  /// The scheduler's callback, with the loop as data.
  static std::uint32_t callback(void* loop) noexcept;

  [[nodiscard]] DeviceLink& link() noexcept { return link_; }
  [[nodiscard]] const DeviceLink& link() const noexcept { return link_; }
  [[nodiscard]] DeviceReadiness readiness() const noexcept {
    return readiness_.load(std::memory_order_acquire);
  }
  /// See HapticDevice::calibrate. May be called from any thread.
  void calibrate() noexcept { reset_requested_.store(true, std::memory_order_release); }
  /// \return how many of the latest consecutive frames sent zero
  [[nodiscard]] int zeros_sent() const noexcept {
    return zeros_sent_.load(std::memory_order_acquire);
  }

  /// Makes all further callbacks return at once and unschedule themselves.
  /// \return false if a callback is still inside the vendor's library at the timeout: then this
  ///   object must never be destroyed
  [[nodiscard]] bool close(std::chrono::milliseconds timeout) noexcept;

 private:
  [[nodiscard]] std::uint32_t run_callback() noexcept;
  void tick() noexcept;
  void check_calibration() noexcept;
  [[nodiscard]] bool is_update_due(Enum state) noexcept;
  void run_frame() noexcept;
  [[nodiscard]] DeviceSample read_sample() noexcept;
  void check_temperature() noexcept;
  void send(Vec3 force_n) noexcept;

  Api api_;
  Handle device_;
  LoopOptions options_;
  DeviceLink link_;
  std::int64_t tick_ = 0;
  bool is_calibrated_ = false;   ///< the position is valid
  std::int64_t idle_ticks_ = 0;  ///< ticks since the last force from a servo
  std::atomic<bool> reset_requested_{false};
  std::atomic<DeviceReadiness> readiness_{DeviceReadiness::needs_calibration};
  std::atomic<int> zeros_sent_{0};
  std::atomic<bool> in_callback_{false};
  std::atomic<bool> closed_{false};
};

}  // namespace touchtrial::device::hd
