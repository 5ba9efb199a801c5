/// \file A device that behaves, for tests of what stops it.
#pragma once

#include "device/servo/servo.hpp"

#include <atomic>
#include <vector>

namespace touchtrial {

/// Rests on the plane, numbers its readings, keeps what it was sent, and counts how often it was
/// halted.
class RestingDevice final : public device::HapticDevice {
 public:
  [[nodiscard]] device::DeviceInfo info() const override { return {"resting", "", 3.3, true}; }
  [[nodiscard]] device::DeviceStatus read(device::DeviceSample& sample) noexcept override {
    sample = {{10.0, 10.0, -1.0}, {}, ++readings_};
    return device::DeviceStatus::ok;
  }
  [[nodiscard]] device::DeviceStatus write(Vec3 force_n) noexcept override {
    written.push_back(force_n);
    return device::DeviceStatus::ok;
  }
  void halt() noexcept override { halts.fetch_add(1); }
  void rearm() noexcept override {}

  std::vector<Vec3> written;
  std::atomic<int> halts{0};

 private:
  std::uint64_t readings_ = 0;
};

class NoSamples final : public device::SampleSink {
 public:
  void record(const device::ServoSample&) noexcept override {}
};

}  // namespace touchtrial
