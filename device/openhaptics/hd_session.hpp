/// \file One opened device of the OpenHaptics library: from loading to letting go.
#pragma once

#include "device/device_settings.hpp"
#include "device/haptic_device.hpp"
#include "device/openhaptics/hd_api.hpp"
#include "device/openhaptics/hd_loop.hpp"

#include <string>

namespace touchtrial::device::hd {

/// For a library that cannot be used.
constexpr const char* kRemedy =
    "install the vendor's OpenHaptics and its device driver, or name the library in the device "
    "settings at openhaptics.library";

/// The library keeps a "current device" and breaks when it is loaded twice: one user a process.
class OnlyUser {
 public:
  /// \throws DeviceError if there is one already
  OnlyUser();
  ~OnlyUser();
  OnlyUser(const OnlyUser&) = delete;
  OnlyUser& operator=(const OnlyUser&) = delete;
};

/// The loaded library and one device of it, without force or scheduler. Opening thread.
class Session {
 public:
  /// \throws DeviceError with the remedy if the library cannot be used or no device answers
  explicit Session(const OpenHapticsSettings& settings);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  [[nodiscard]] const Api& api() const noexcept { return api_; }
  [[nodiscard]] Handle device() const noexcept { return device_; }
  [[nodiscard]] DeviceInfo info() const;
  [[nodiscard]] LoopOptions loop_options() const;

  /// \throws DeviceError naming what was tried, and the library's own words, if it left an error
  void expect_no_error(const std::string& what) const;

 private:
  OnlyUser only_user_;
  std::string name_;  ///< of the library
  DynamicLibrary library_;
  Api api_;
  Handle device_;
};

}  // namespace touchtrial::device::hd
