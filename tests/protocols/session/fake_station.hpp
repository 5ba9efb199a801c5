/// \file A device on a cable that tests can pull, with a hand that strokes the plane by itself.
#pragma once

#include "device/haptic_device.hpp"
#include "protocols/session/device_station.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace touchtrial {

/// The world outside the program: whether the device is plugged in, and the forces that reached its
/// motors.
struct Cable {
  std::atomic<bool> plugged{true};
  std::atomic<bool> homed{true};
  std::atomic<bool> needs_reset{false};  ///< until somebody says that the arm is at its place
  std::atomic<int> pull_at_tick{-1};     ///< the cable comes off in this tick, once
  std::atomic<int> opened{0};
  std::atomic<int> writes_unarmed{0};     ///< forces other than zero while halted
  std::atomic<int> strong_writes{0};      ///< forces other than zero
  std::atomic<bool> last_was_zero{true};  ///< the last force that was written
  std::string serial = "A1";
};

/// Strokes the plane to and fro at 60 mm/s, 0.3 mm deep, after coming down for 50 ticks.
class FakeDevice final : public device::HapticDevice {
 public:
  explicit FakeDevice(Cable& cable) : cable_(cable) { ++cable.opened; }
  ~FakeDevice() override { cable_.last_was_zero = true; }

  [[nodiscard]] device::DeviceInfo info() const override;
  [[nodiscard]] device::DeviceStatus read(device::DeviceSample& sample) noexcept override;
  [[nodiscard]] device::DeviceStatus write(Vec3 force_n) noexcept override;
  void halt() noexcept override { halted_ = true; }
  void rearm() noexcept override { halted_ = false; }
  [[nodiscard]] device::DeviceFault fault() const noexcept override {
    return lost_ ? device::DeviceFault::link_lost : device::DeviceFault::none;
  }
  [[nodiscard]] device::DeviceReadiness readiness() const noexcept override {
    if (cable_.needs_reset) return device::DeviceReadiness::needs_reset;
    return cable_.homed ? device::DeviceReadiness::ready : device::DeviceReadiness::needs_homing;
  }
  void calibrate() noexcept override { cable_.needs_reset = false; }
  /// Begins a new exploration: raises the hand.
  void lift() noexcept { tick_ = 0; }

 private:
  Cable& cable_;
  std::atomic<bool> halted_{false};
  std::atomic<bool> lost_{false};
  std::atomic<int> tick_{0};
  std::uint64_t sequence_ = 0;
};

/// Remembers what was missing; plugs the cable in when asked for the second time.
class Helper final : public session::Attendant {
 public:
  explicit Helper(Cable& cable) : cable_(cable) {}

  [[nodiscard]] Reply poll(const std::string& need) override;

  std::vector<std::string> needs;
  bool gives_up = false;
  bool plugs_in = true;
  bool resets = false;  ///< puts the arm at its place and says so
  int consents = 0;

 private:
  Cable& cable_;
};

/// Opens the fake device, and points `device` to it.
[[nodiscard]] session::DeviceStation::Open opener(Cable& cable, FakeDevice*& device);

}  // namespace touchtrial
