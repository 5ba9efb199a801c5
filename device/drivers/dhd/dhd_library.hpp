/// \file Finds and loads Force Dimension's library. The functions that the driver uses are declared
///   here from the public documentation, so that a build does not need the vendor's SDK. Private to
///   this folder.
#pragma once

#include "device/platform/dynamic_library.hpp"

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial::device::dhd {

/// \name Results of most functions
/// @{ A number below 0 is an error; 0 and these are success.
constexpr int kTimeGuard = 1;       ///< no exchange: the last values are newer than the time guard
constexpr int kMotorSaturated = 2;  ///< the motors exert less force than requested
///@}

/// The status array and its indices; larger than in any version, so that a newer library does not
/// overflow it.
using Status = std::array<int, 32>;
constexpr std::size_t kConnected = 1;
constexpr std::size_t kReset = 3;  ///< the device waits for its calibration
constexpr std::size_t kForce = 5;  ///< force is switched on
constexpr std::size_t kError = 9;
constexpr std::size_t kForceOffCause = 14;  ///< of the last switch-off, even an old one

/// Causes of switch-offs by the device itself. Other causes are its button or the driver.
constexpr int kOffByVelocity = 2;
constexpr int kOffByWatchdog = 3;
constexpr int kOffByUnplugging = 5;

constexpr int kRecommendedTimeGuard = -1;
/// The device switches force off after this many times 125 us (10 ms) without a command.
constexpr unsigned char kWatchdog = 80;
/// The size of the library's joint arrays. The first three joints are the arms.
constexpr std::size_t kJoints = 8;

/// The library's functions: get_device_count is dhdGetDeviceCount, and so on. The last argument is
/// the device.
struct Api {
  int (*get_device_count)();
  int (*open_id)(char);
  int (*close)(char);
  int (*get_position)(double*, double*, double*, char);  ///< m
  int (*set_force)(double, double, double, char);        ///< N
  int (*enable_force)(unsigned char, char);
  unsigned (*get_button_mask)(char);
  int (*get_status)(int*, char);
  int (*set_time_guard)(int, char);
  int (*set_gravity_compensation)(int, char);  ///< on: the library adds the weight to every force
  const char* (*error_get_last_str)();

  /// \name Null if the library lacks them
  ///@{
  int (*stop)(char);  ///< force off and brakes on
  int (*enable_expert_mode)();
  int (*disable_expert_mode)();
  int (*get_system_type)(char);
  const char* (*get_system_name)(char);
  int (*get_serial_number)(unsigned short*, char);
  int (*get_version)(double*, char);
  void (*get_sdk_version)(int*, int*, int*, int*);  ///< major, minor, release, revision
  int (*set_effector_mass)(double, char);           ///< kg
  int (*get_effector_mass)(double*, char);          ///< kg
  int (*set_max_force)(double, char);               ///< N; below 0: no limit
  int (*set_watchdog)(unsigned char, char);
  int (*get_watchdog)(unsigned char*, char);
  int (*get_joint_angles)(double*, char);                                               ///< rad
  int (*joint_angles_to_gravity_joint_torques)(double*, double*, unsigned char, char);  ///< N m
  int (*get_delta_joint_angles)(double*, double*, double*, char);
  int (*delta_gravity_joint_torques)(double, double, double, double*, double*, double*, char);
  int (*delta_joint_angles_to_jacobian)(double, double, double, double (*)[3], char);
  ///@}

  /// \name Only in libdrd, which also has the others: drd_open_id is drdOpenID, and so on
  ///@{
  int (*drd_open_id)(char);
  int (*drd_close)(char);
  bool (*drd_is_initialized)(char);
  int (*drd_auto_init)(char);  ///< moves the arm
  ///@}

  [[nodiscard]] bool has_drd() const noexcept {
    return drd_open_id != nullptr && drd_close != nullptr && drd_is_initialized != nullptr;
  }
};

/// \return whether a device with this status is calibrated
[[nodiscard]] inline bool is_calibrated(const Api& api, const Status& status,
                                        char device) noexcept {
  return status[kReset] == 0 && (!api.has_drd() || api.drd_is_initialized(device));
}

/// Calls a function that newer versions allow only in expert mode. The mode is left at once,
/// because it allows functions that disable safety.
template <typename Call>
auto as_expert(const Api& api, Call call) noexcept(noexcept(call())) {
  if (api.enable_expert_mode != nullptr) (void)api.enable_expert_mode();
  const auto result = call();
  if (api.disable_expert_mode != nullptr) (void)api.disable_expert_mode();
  return result;
}

/// The remedy for a library that cannot be used.
extern const char* const kRemedy;

/// \param library  the setting dhd.library: a file, a folder of the SDK, or a bare name
/// \return candidates, best first: libdrd before libdhd, which it contains, and newer before older
///   versions. For the default libdhd.so, a name that the SDK does not use, also the SDK's names in
///   the linker's path, the SDK's folder (environment FDSDK), and the usual folders.
[[nodiscard]] std::vector<std::filesystem::path> library_candidates(
    const std::filesystem::path& library);

/// The loaded library, with no device open.
class Library {
 public:
  /// Loads the first candidate that exists, after a test in a child process.
  /// \throws DeviceError with the remedy if none exists or it cannot be used
  explicit Library(const std::filesystem::path& library);

  [[nodiscard]] const Api& api() const noexcept { return api_; }
  /// \return the loaded file
  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }
  /// \return the number of connected devices, >= 0
  [[nodiscard]] int device_count() const noexcept;
  /// \return the library's message for its last error on this thread
  [[nodiscard]] std::string last_error() const;

 private:
  std::filesystem::path file_;
  DynamicLibrary library_;
  Api api_;
};

}  // namespace touchtrial::device::dhd
