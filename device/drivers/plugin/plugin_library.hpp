/// \file The host's side of a plug-in: its library, an open device, and validation of everything it
///   returns. It exposes the C interface, so only device/ may include it.
#pragma once

#include "device/drivers/plugin/touchtrial_device.h"
#include "device/haptic_device.hpp"
#include "device/platform/dynamic_library.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace touchtrial::device::plugin {

/// A loaded library with a complete interface. It is never unloaded, because its threads may still
/// be running.
class Library {
 public:
  /// \throws DeviceError with the remedy if no library is named, it cannot be loaded, or its
  ///   interface has another version or size, a null function, or an invalid name
  explicit Library(const std::filesystem::path& file);

  /// The driver's name: letters, digits, - and _.
  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] const std::string& file() const noexcept { return file_; }
  [[nodiscard]] const touchtrial_device_api& api() const noexcept { return *api_; }
  /// \return the motors' force command of the last opened device, N, device frame; nothing if the
  ///   plug-in reports none that is finite. Any thread.
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
  absurd,              ///< an impossibly large position or velocity
  sequence_decreased,  ///< a smaller sequence number than in the previous reading
  unknown_readiness,   ///< a readiness that the interface does not define
  wrote_past,          ///< a write beyond the end of a structure
};
[[nodiscard]] DeviceFault fault_of(PluginFault plugin_fault) noexcept;
/// \return a phrase for messages, for instance "gave a position or velocity that is not a number"
[[nodiscard]] const char* fault_text(PluginFault plugin_fault) noexcept;

struct Reading {
  PluginFault plugin_fault = PluginFault::none;
  bool is_new = false;  ///< whether its sequence number is greater than the last one's
  DeviceSample sample;  ///< without sequence number
  DeviceReadiness readiness = DeviceReadiness::needs_calibration;
};

/// An open device; the destructor closes it. One thread at a time.
class OpenDevice {
 public:
  /// \param library  must outlive this
  /// \param settings  a JSON object
  /// \throws DeviceError with the plug-in's message if it does not open
  OpenDevice(const Library& library, const std::string& settings);
  ~OpenDevice();
  OpenDevice(const OpenDevice&) = delete;
  OpenDevice& operator=(const OpenDevice&) = delete;

  /// \throws DeviceError naming the member that is invalid
  [[nodiscard]] DeviceInfo info() const;

  /// \name For the device's thread: no allocation, lock or exception in the host
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

/// The remedy in errors about an unusable plug-in.
inline constexpr const char* kRemedy =
    "correct the plug-in, or name another library in the device settings at plugin.library";

}  // namespace touchtrial::device::plugin
