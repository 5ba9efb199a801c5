/// \file A device that behaves, for tests of what stops it.
#pragma once

#include "device/servo/servo.hpp"

#include <atomic>
#include <vector>

namespace touchtrial {

/// Rests on the plane, numbers its readings, keeps what it was sent, and counts how often it was
/// halted.
class RestingDevice final : public HapticDevice {
 public:
  [[nodiscard]] DeviceInfo info() const override { return {"resting", "", 3.3, true}; }
  [[nodiscard]] DeviceStatus read(DeviceSample& sample) noexcept override {
    sample = {{10.0, 10.0, -1.0}, {}, ++readings_};
    return DeviceStatus::ok;
  }
  [[nodiscard]] DeviceStatus write(Vec3 force_n) noexcept override {
    written.push_back(force_n);
    return DeviceStatus::ok;
  }
  void halt() noexcept override { halts.fetch_add(1); }
  void rearm() noexcept override {}

  std::vector<Vec3> written;
  std::atomic<int> halts{0};

 private:
  std::uint64_t readings_ = 0;
};

class NoSamples final : public SampleSink {
 public:
  void record(const ServoSample&) noexcept override {}
};

}  // namespace touchtrial
