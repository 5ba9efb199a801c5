/// \file Devices, forces, a clock and limits for the tests of the servo and the safety chain.
#pragma once

#include "device/safety/safety_limits.hpp"
#include "device/servo/servo.hpp"

#include <atomic>
#include <deque>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace touchtrial {

/// Stays where it is, keeps what it was sent, and ends or fails at a chosen tick.
class ScriptedDevice final : public device::HapticDevice {
 public:
  [[nodiscard]] device::DeviceInfo info() const override {
    device::DeviceInfo info{"scripted", "", max_force_n, true};
    info.max_support_n = 2.0;
    return info;
  }
  [[nodiscard]] device::DeviceStatus read(device::DeviceSample& sample) noexcept override {
    sample.sequence = static_cast<std::uint64_t>(reads) + 1;
    sample.position_mm = {static_cast<double>(reads), 0.0, -1.0};
    return reads++ < ticks ? device::DeviceStatus::ok : end;
  }
  [[nodiscard]] device::DeviceStatus write(Vec3 force_n) noexcept override {
    written.push_back(force_n);
    return static_cast<int>(written.size()) == fails_at_write ? device::DeviceStatus::fault
                                                              : device::DeviceStatus::ok;
  }
  [[nodiscard]] Vec3 support_force_n(const device::DeviceSample& sample) noexcept override {
    supported_mm = sample.position_mm;
    return support_n;
  }
  void halt() noexcept override {}
  void rearm() noexcept override {}
  [[nodiscard]] device::DeviceFault fault() const noexcept override { return device_fault; }

  double max_force_n = 3.3;
  Vec3 support_n;
  Vec3 supported_mm;  ///< where it was asked for the last support
  int ticks = 1'000'000;
  int fails_at_write = 0;
  device::DeviceStatus end = device::DeviceStatus::stopped;
  device::DeviceFault device_fault = device::DeviceFault::none;
  int reads = 0;
  std::vector<Vec3> written;
};

class ConstantForce final : public device::ForceSource {
 public:
  explicit ConstantForce(Vec3 force_n) : force_n_(force_n) {}
  [[nodiscard]] Vec3 force_n(const device::DeviceSample&) noexcept override { return force_n_; }

 private:
  Vec3 force_n_;
};

/// Forces by a function of the sample.
class ForceBy final : public device::ForceSource {
 public:
  using Law = std::function<Vec3(const device::DeviceSample& sample)>;
  explicit ForceBy(Law law) : law_(std::move(law)) {}
  [[nodiscard]] Vec3 force_n(const device::DeviceSample& sample) noexcept override {
    return law_(sample);
  }

 private:
  Law law_;
};

/// Wakes the servo late by script: the first wait by the first delay, and so on; then on time.
class LateClock final : public device::ServoClock {
 public:
  explicit LateClock(std::deque<Time> delays) : delays_(std::move(delays)) {}

  [[nodiscard]] Time now() noexcept override { return now_; }
  void wait_until(Time time) noexcept override {
    if (time > now_) now_ = time;
    if (delays_.empty()) return;
    now_ += delays_.front();
    delays_.pop_front();
  }

 private:
  std::deque<Time> delays_;
  Time now_ = std::chrono::hours(5);
};

/// Rests on the plane, numbers its readings, keeps what it was sent, and counts how often it was
/// halted.
class RestingDevice final : public device::HapticDevice {
 public:
  [[nodiscard]] device::DeviceInfo info() const override {
    device::DeviceInfo info{"resting", "", 3.3, true};
    info.has_encoders = has_encoders;
    return info;
  }
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
  bool has_encoders = false;

 private:
  std::uint64_t readings_ = 0;
};

class NoSamples final : public device::SampleSink {
 public:
  void record(const device::ServoSample&) noexcept override {}
};

/// \return limits of which only the norm limit affects a device that behaves
[[nodiscard]] inline device::SafetyLimits norm_limit_alone(double max_force_n = 3.3) {
  return {.max_force_n = max_force_n,
          .max_slew_n_per_s = std::numeric_limits<double>::infinity(),
          .max_speed_mm_s = std::numeric_limits<double>::infinity(),
          .engage_force_n = std::numeric_limits<double>::infinity(),
          .ramp_up_s = 0.0};
}

}  // namespace touchtrial
