#include "device/dhd/dhd_loop.hpp"

#include "device/platform/realtime.hpp"

#include <algorithm>
#include <chrono>

namespace touchtrial::device::dhd {
namespace {

constexpr std::chrono::nanoseconds kPeriod{static_cast<std::int64_t>(1e9 / kPollRateHz)};
constexpr std::int64_t kTicksBetweenStatus = 40;
constexpr int kZerosAtTheEnd = 5;
constexpr double kMmPerM = 1000.0;

/// The library's frame has x towards the person, y to the right and z up.
Vec3 to_device_frame(Vec3 dhd) noexcept {
  return {dhd.y, dhd.z, dhd.x};
}
Vec3 to_dhd_frame(Vec3 device) noexcept {
  return {device.z, device.x, device.y};
}

}  // namespace

Loop::Loop(const Api& api, char device) : api_(api), device_(device), thread_([this] { run(); }) {}

Loop::~Loop() {
  closing_.store(true, std::memory_order_release);
  thread_.join();
}

void Loop::run() noexcept {
  (void)request_scheduling({});
  std::chrono::nanoseconds next = monotonic_now();
  while (!closing_.load(std::memory_order_acquire)) {
    tick();
    next = std::max(next + kPeriod, monotonic_now());  // no burst after a stall
    sleep_until(next);
  }
  for (int i = 0; i < kZerosAtTheEnd; ++i) (void)api_.set_force(0.0, 0.0, 0.0, device_);
}

void Loop::tick() noexcept {
  if (tick_++ % kTicksBetweenStatus == 0) check_status();
  take_sample();
  const Vec3 force_n = link_.force_to_send(monotonic_now());
  send(may_push() ? force_n : Vec3{});
}

void Loop::check_status() noexcept {
  Status status{};
  if (api_.get_status(status.data(), device_) < 0 || status[kConnected] == 0) {
    link_.fail(DeviceFault::link_lost);
    return;
  }
  if (status[kError] != 0) link_.fail(DeviceFault::driver);
  force_on_ = status[kForce] != 0;
  if (!force_on_) judge_force_off(status[kForceOffCause]);
  readiness_.store(
      status[kReset] != 0 ? DeviceReadiness::ready : DeviceReadiness::needs_calibration,
      std::memory_order_release);
}

/// A person may switch force off at the device; that is no fault, and the samples are not ready.
void Loop::judge_force_off(int cause) noexcept {
  if (cause == kOffByVelocity) link_.fail(DeviceFault::limit_passed);
  if (cause == kOffByWatchdog) link_.fail(DeviceFault::driver);
  if (cause == kOffByUnplugging) link_.fail(DeviceFault::link_lost);
}

void Loop::take_sample() noexcept {
  Vec3 position_m;
  Vec3 velocity_m_s;
  const int got = api_.get_position(&position_m.x, &position_m.y, &position_m.z, device_);
  if (got < 0 ||
      api_.get_linear_velocity(&velocity_m_s.x, &velocity_m_s.y, &velocity_m_s.z, device_) < 0) {
    fail_call();
    return;
  }
  if (!is_finite(position_m) || !is_finite(velocity_m_s)) {
    link_.fail(DeviceFault::bad_data);
    return;
  }
  if (got == kTimeGuard) return;  // nothing newer: the sequence number tells the servo
  DeviceSample sample;
  sample.position_mm = kMmPerM * to_device_frame(position_m);
  sample.velocity_mm_s = kMmPerM * to_device_frame(velocity_m_s);
  sample.buttons = api_.get_button_mask(device_);
  sample.ready = may_push();
  link_.publish(sample);
}

void Loop::send(Vec3 force_n) noexcept {
  const Vec3 force = to_dhd_frame(force_n);
  if (api_.set_force(force.x, force.y, force.z, device_) < 0) fail_call();
}

/// Reports a failed call: the device is gone, or the library has a reason of its own.
void Loop::fail_call() noexcept {
  Status status{};
  const bool there = api_.get_status(status.data(), device_) >= 0 && status[kConnected] != 0;
  link_.fail(there ? DeviceFault::driver : DeviceFault::link_lost);
}

}  // namespace touchtrial::device::dhd
