/// \file Exchange of states and forces between a driver's thread and the servo, and a device that
///   uses it.
#pragma once

#include "device/haptic_device.hpp"
#include "device/platform/realtime.hpp"
#include "device/servo/latest_value.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>

namespace touchtrial::device {

/// Lock-free exchange for drivers whose link (USB transfers, a vendor's scheduler) runs on a
/// separate thread. HapticDevice's functions of the same names forward to it.
class DeviceLink {
 public:
  using Time = std::chrono::nanoseconds;  ///< of one monotonic clock, which the driver chooses

  /// A force older than this is replaced by zero, because the servo has stalled.
  static constexpr Time kForceLifetime = std::chrono::milliseconds(10);

  /// \name Servo thread
  ///@{
  /// Reads the newest sample.
  /// \return fault once `fail` was called; never `stopped`
  [[nodiscard]] DeviceStatus read(DeviceSample& sample) noexcept {
    sample = samples_.get();
    return status();
  }
  /// \return fault once `fail` was called
  [[nodiscard]] DeviceStatus write(Vec3 force_n, Time now) noexcept {
    forces_.set({force_n, now, true});
    return status();
  }
  ///@}

  /// \name Any thread, and signal handlers
  ///@{
  void halt() noexcept { halted_.store(true, std::memory_order_release); }
  void rearm() noexcept { halted_.store(false, std::memory_order_release); }
  [[nodiscard]] DeviceFault fault() const noexcept {
    return fault_.load(std::memory_order_acquire);
  }
  /// \return whether `halt` or `fail` suppresses all force
  [[nodiscard]] bool is_stopped() const noexcept {
    return halted_.load(std::memory_order_acquire) || fault() != DeviceFault::none;
  }
  /// Latches the first fault: the force stays zero until the device is reopened.
  void fail(DeviceFault fault) noexcept {
    DeviceFault expected = DeviceFault::none;
    fault_.compare_exchange_strong(expected, fault, std::memory_order_acq_rel);
  }
  ///@}

  /// \name Driver's thread
  /// @{ Numbers a sample and passes it to the servo.
  void publish(DeviceSample sample) noexcept {
    sample.sequence = ++published_;
    samples_.set(sample);
  }
  /// \return the force to send now, device frame, N: the servo's newest, or zero if there is none,
  ///   if it is too old, or after `halt` or `fail`
  [[nodiscard]] Vec3 force_to_send(Time now) noexcept { return live_force(now).value_or(Vec3{}); }
  /// The same for drivers that must detect a missing force: nothing instead of zero in these cases.
  [[nodiscard]] std::optional<Vec3> live_force(Time now) noexcept {
    const TimedForce& newest = forces_.get();
    const bool is_usable = newest.is_set && now - newest.written_at <= kForceLifetime &&
                           !halted_.load(std::memory_order_acquire) && fault() == DeviceFault::none;
    return is_usable ? std::optional(newest.force_n) : std::nullopt;
  }
  ///@}

 private:
  static_assert(std::atomic<DeviceFault>::is_always_lock_free, "signal handlers read it");

  struct TimedForce {
    Vec3 force_n;
    Time written_at{};
    bool is_set = false;
  };

  [[nodiscard]] DeviceStatus status() const noexcept {
    return fault() == DeviceFault::none ? DeviceStatus::ok : DeviceStatus::fault;
  }

  LatestValue<DeviceSample> samples_{DeviceSample{{}, {}, 0, 0, false}};
  LatestValue<TimedForce> forces_;
  std::uint64_t published_ = 0;
  std::atomic<bool> halted_{false};
  std::atomic<DeviceFault> fault_{DeviceFault::none};
};

/// The clock and sleep of a driver's thread, so that tests control them.
class LinkPace {
 public:
  using Time = DeviceLink::Time;
  virtual ~LinkPace() = default;
  /// The monotonic time. May be called from any thread.
  [[nodiscard]] virtual Time now() noexcept = 0;
  /// Sleeps on the driver's thread until its next exchange is due.
  virtual void rest_until(Time time) noexcept = 0;
  /// Called when the driver's thread has waited this long without an answer; advances a virtual
  /// clock.
  virtual void on_wait(Time /*time*/) noexcept {}
  /// Ends all sleeps, because the device is being closed or the driver's thread has ended.
  /// Thread-safe.
  virtual void end() noexcept {}
};

/// Real time.
class RealLinkPace final : public LinkPace {
 public:
  [[nodiscard]] Time now() noexcept override { return monotonic_now(); }
  void rest_until(Time time) noexcept override { sleep_until(time); }
};

/// A device behind a DeviceLink.
class LinkedDevice : public HapticDevice {
 public:
  [[nodiscard]] DeviceStatus read(DeviceSample& sample) noexcept final {
    return link().read(sample);
  }
  [[nodiscard]] DeviceStatus write(Vec3 force_n) noexcept final {
    return link().write(force_n, link_time());
  }
  void halt() noexcept final { link().halt(); }
  void rearm() noexcept final { link().rearm(); }
  [[nodiscard]] DeviceFault fault() const noexcept final { return link().fault(); }

 private:
  /// \return the same object during the device's lifetime
  [[nodiscard]] virtual DeviceLink& link() const noexcept = 0;
  /// \return the current time on the link's clock
  [[nodiscard]] virtual DeviceLink::Time link_time() const noexcept { return monotonic_now(); }
};

}  // namespace touchtrial::device
