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
/// rate. Everything from a plug-in is validated. Zero is sent before the device is ready, after
/// `halt` and every fault, and 10 ms after the servo's last `write`; only otherwise are the
/// plug-in's motors enabled. A fault latches: reopen the device.
///
/// A blocking call makes the samples stale, which ends a run. If it never returns, device and
/// thread are leaked, and nothing waits for them.
class PluginDevice final : public LinkedDevice {
 public:
  /// \throws DeviceError with the remedy if the library cannot be used, the device does not open,
  ///   or its description is impossible
  explicit PluginDevice(const PluginSettings& settings, PluginOptions options = {});
  /// Sends zeros, disables the motors and closes the device.
  ~PluginDevice() override;

  [[nodiscard]] DeviceInfo info() const override;
  [[nodiscard]] DeviceReadiness readiness() const noexcept override;
  /// The cause of the first fault. Any thread.
  [[nodiscard]] plugin::PluginFault trouble() const noexcept;

 private:
  [[nodiscard]] DeviceLink& link() const noexcept override;
  [[nodiscard]] DeviceLink::Time link_time() const noexcept override;

  struct Running;
  std::shared_ptr<Running> running_;  ///< shared with a thread that may never end
  std::future<void> ended_;
  std::thread thread_;
};

}  // namespace touchtrial::device
