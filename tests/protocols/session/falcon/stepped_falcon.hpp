/// \file The real Falcon driver on an emulated Falcon, one exchange through libusb a servo tick,
/// and the people around it.
#pragma once

#include "device/falcon/emulator/hand_on_falcon.hpp"
#include "device/falcon/rig/falcon_rig.hpp"
#include "device/falcon/usbfs_shim/usb_model.hpp"
#include "device/falcon/usbfs_shim/usbfs_shim.hpp"
#include "protocols/session/device_station.hpp"

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace touchtrial::device::falcon {

/// A Falcon on the bus, switched on and never loaded, with a hand on its grip.
struct EmulatedFalcon {
  explicit EmulatedFalcon(const device::PlanePlacement& placement);

  /// Cable and power: firmware and homing are gone afterwards.
  void unplug();
  void plug();

  HandOnFalcon hand;
  FalconEmulator emulator;
  testing::EmulatorUsbModel model{emulator};
  testing::ShimmedUsbDevice usb{model};
  std::atomic<bool> plugged{true};
};

/// FalconDevice in lockstep, with its lockstep.
class SteppedFalcon final : public device::HapticDevice {
 public:
  /// \param before_read  on the servo's thread, while the USB thread rests; may be empty
  SteppedFalcon(const device::FalconSettings& settings, std::function<void()> before_read);

  [[nodiscard]] device::DeviceInfo info() const override { return falcon_->info(); }
  [[nodiscard]] device::DeviceStatus read(device::DeviceSample& sample) noexcept override;
  [[nodiscard]] device::DeviceStatus write(Vec3 force_n) noexcept override;
  [[nodiscard]] Vec3 support_force_n(const device::DeviceSample& sample) noexcept override {
    return falcon_->support_force_n(sample);
  }
  void halt() noexcept override { falcon_->halt(); }
  void rearm() noexcept override { falcon_->rearm(); }
  [[nodiscard]] device::DeviceFault fault() const noexcept override { return falcon_->fault(); }
  [[nodiscard]] device::DeviceReadiness readiness() const noexcept override {
    return falcon_->readiness();
  }
  void steps(int count) noexcept { lockstep_.steps(count); }

 private:
  Lockstep lockstep_;
  std::unique_ptr<FalconDevice> falcon_;
  std::function<void()> before_read_;
};

/// Does what the program asks for: plugs the Falcon in, homes its grip, and consents. Records the
/// force on the grip at every call.
class Experimenter final : public session::Attendant {
 public:
  Experimenter(EmulatedFalcon& falcon, SteppedFalcon*& device) : falcon_(falcon), device_(device) {}
  [[nodiscard]] Says attend(const std::string& need) override;

  std::vector<std::string> needs;
  int consents = 0;
  double strongest_n = 0.0;  ///< before consent to force

 private:
  EmulatedFalcon& falcon_;
  SteppedFalcon*& device_;
};

}  // namespace touchtrial::device::falcon
