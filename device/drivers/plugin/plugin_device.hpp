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

/// The driver "plugin". A thread of its own samples the device and sends the force, as often as the
/// plug-in says. It believes nothing that a plug-in says without judging it, and sends zero before
/// the device is ready, after `halt` and every fault, and 10 ms after the servo's last `write`; the
/// plug-in's motors are enabled only in between. A fault latches: open the device anew.
///
/// A call that blocks lets the samples grow old, which ends a run. If it never returns, the device
/// and its thread are left behind: nothing waits for it.
class PluginDevice final : public LinkedDevice {
 public:
  /// \throws DeviceError with the remedy if the library cannot be used, the device does not open, or
  ///   describes itself as no device can be
  explicit PluginDevice(const PluginSettings& settings, PluginOptions options = {});
  /// Sends zeros, disables the motors and closes the device.
  ~PluginDevice() override;

  [[nodiscard]] DeviceInfo info() const override;
  [[nodiscard]] DeviceReadiness readiness() const noexcept override;
  /// What led to the first fault. Any thread.
  [[nodiscard]] plugin::PluginFault trouble() const noexcept;

 private:
  [[nodiscard]] DeviceLink& link() const noexcept override;
  [[nodiscard]] DeviceLink::Time link_time() const noexcept override;

  struct Running;
  std::shared_ptr<Running> running_;  ///< a thread that never ends keeps it
  std::future<void> ended_;
  std::thread thread_;
};

}  // namespace touchtrial::device
