/// \file A lab's own driver: a shared library with the C interface of touchtrial_device.h.
#pragma once

#include "device/device_settings.hpp"
#include "device/drivers/device_link.hpp"
#include "device/platform/realtime.hpp"

#include <cstdint>
#include <future>
#include <memory>
#include <thread>

namespace touchtrial::device {

namespace plugin {
enum class PluginFault : std::uint8_t;
}

struct PluginOptions {
  std::unique_ptr<LinkPace> pace = std::make_unique<RealLinkPace>();
  SchedulingRequest scheduling{};  ///< of the device's thread
};

/// The driver "plugin". A separate thread samples the device and sends the force at the plug-in's
/// rate. Everything from a plug-in is validated. The motors are disabled and zero is sent before
/// the device is ready, after `halt` and every fault, and from 10 ms after the servo's last
/// `write`. A fault latches until the device is reopened.
///
/// A blocking call makes the samples stale, which ends a run. If it never returns, the destructor
/// leaks device and thread instead of waiting.
class PluginDevice final : public LinkedDevice {
 public:
  /// \throws DeviceError with the remedy if the library cannot be used, the device does not open,
  ///   or its description is invalid
  explicit PluginDevice(const PluginSettings& settings, PluginOptions options = {});
  /// Sends zeros, disables the motors and closes the device.
  ~PluginDevice() override;

  [[nodiscard]] DeviceInfo info() const override;
  [[nodiscard]] DeviceReadiness readiness() const noexcept override;
  /// \return the cause of the first fault. Any thread.
  [[nodiscard]] plugin::PluginFault plugin_fault() const noexcept;

 private:
  [[nodiscard]] DeviceLink& link() const noexcept override;
  [[nodiscard]] DeviceLink::Time link_time() const noexcept override;

  struct Runtime;
  std::shared_ptr<Runtime> runtime_;  ///< shared with a thread that may never end
  std::future<void> thread_end_;
  std::thread thread_;
};

}  // namespace touchtrial::device
