/// \file The host's side of a plug-in: its library, one open device, and validation of everything
///   it returns. It exposes the C interface, which stays within device/.
#pragma once

#include "device/drivers/plugin/touchtrial_device.h"
#include "device/haptic_device.hpp"
#include "device/platform/dynamic_library.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace touchtrial::device::plugin {

/// The loaded library with a complete interface. It is never unloaded, because its own threads may
/// still run.
class Library {
 public:
  /// \throws DeviceError naming library and remedy if it is not named or cannot be loaded, or its
  ///   interface has another version or size, a null function, or an invalid name
  explicit Library(const std::filesystem::path& file);

  /// Of the driver: letters, digits, - and _.
  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] const std::string& file() const noexcept { return file_; }
  [[nodiscard]] const touchtrial_device_api& api() const noexcept { return *api_; }
  /// \return the force command of the motors of the last opened device, N, device frame; nothing if
  ///   the plug-in does not report a finite one. Any thread.
  [[nodiscard]] std::optional<Vec3> observed_force_n() const noexcept;

 private:
  std::string file_;
  DynamicLibrary library_;
  const touchtrial_device_api* api_ = nullptr;
  decltype(&touchtrial_device_observe_v1) observe_ = nullptr;
  std::string name_;
};

/// A fault that the host found in a call.
enum class PluginFault : std::uint8_t {
  none,
  lost,
  bad_data,
  warm_motors,
  limit_passed,
  failed,
  not_finite,          ///< a position or velocity
  absurd,              ///< a position or velocity that no device has
  sequence_decreased,  ///< a reading with a smaller number than the one before
  unknown_readiness,   ///< a number that the interface does not have
  wrote_past,          ///< wrote beyond the size of a structure
};
[[nodiscard]] DeviceFault fault_of(PluginFault trouble) noexcept;
/// For a person: "gave a position or velocity that is not a number".
[[nodiscard]] const char* words_for(PluginFault trouble) noexcept;

struct Reading {
  PluginFault trouble = PluginFault::none;
  bool is_new = false;  ///< since the last one
  DeviceSample sample;  ///< without our sequence number
  DeviceReadiness readiness = DeviceReadiness::needs_calibration;
};

/// One open device; the destructor closes it. One thread at a time.
class OpenDevice {
 public:
  /// \param library  must outlive this
  /// \param settings  a JSON object
  /// \throws DeviceError with the plug-in's message if it does not open
  OpenDevice(const Library& library, const std::string& settings);
  ~OpenDevice();
  OpenDevice(const OpenDevice&) = delete;
  OpenDevice& operator=(const OpenDevice&) = delete;

  /// \throws DeviceError naming the impossible member
  [[nodiscard]] DeviceInfo info() const;

  /// \name For the device's thread: no heap, lock or exception on our side
  ///@{
  [[nodiscard]] Reading sample() noexcept;
  [[nodiscard]] PluginFault force(Vec3 force_n) noexcept;
  [[nodiscard]] PluginFault enable(bool on) noexcept;
  ///@}

 private:
  const Library& library_;
  touchtrial_device* device_;
  std::uint64_t last_sequence_ = 0;
};

/// Ends the errors about a plug-in that cannot be used.
inline constexpr const char* kRemedy =
    "correct the plug-in, or name another library in the device settings at plugin.library";

}  // namespace touchtrial::device::plugin
