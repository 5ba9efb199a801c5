/// \file One opened device of the DHD library: from loading to closing.
#pragma once

#include "device/device_settings.hpp"
#include "device/dhd/dhd_api.hpp"
#include "device/haptic_device.hpp"

#include <string>

namespace touchtrial::device::dhd {

/// For a library that cannot be used.
constexpr const char* kRemedy =
    "install Force Dimension's SDK, or name the library in the device settings at dhd.library";

/// The loaded library, without a device.
class Library {
 public:
  /// \throws DeviceError with the remedy if it cannot be used
  explicit Library(const std::filesystem::path& file);
  [[nodiscard]] const Api& api() const noexcept { return api_; }
  /// Devices that are connected, >= 0.
  [[nodiscard]] int device_count() const noexcept;
  /// The library's own words for what failed last.
  [[nodiscard]] std::string last_error() const;

 private:
  DynamicLibrary library_;
  Api api_;
};

/// An open device, force off. Opening thread. Force is off again, and the device closed, on every
/// way out.
class Session {
 public:
  /// \throws DeviceError with the remedy if the library cannot be used or the device not opened
  explicit Session(const DhdSettings& settings);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  [[nodiscard]] const Api& api() const noexcept { return library_.api(); }
  [[nodiscard]] char device() const noexcept { return device_; }
  [[nodiscard]] DeviceInfo info() const;
  /// Effector mass, gravity compensation, time guard, and force on.
  /// \throws DeviceError naming what failed
  void configure();

 private:
  void expect(int result, const std::string& what) const;
  void set_time_guard() const;

  DhdSettings settings_;
  Library library_;
  char device_;
};

}  // namespace touchtrial::device::dhd
