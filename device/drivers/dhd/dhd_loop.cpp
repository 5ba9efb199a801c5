#include "device/drivers/dhd/dhd_loop.hpp"

#include "device/drivers/dhd/dhd_gravity.hpp"
#include "device/platform/realtime.hpp"

#include <algorithm>

namespace touchtrial::device::dhd {
namespace {

constexpr std::chrono::nanoseconds kPeriod{static_cast<std::int64_t>(1e9 / kPollRateHz)};
constexpr std::int64_t kTicksBetweenStatus = 40;
/// The library removes the weight within 250 ms after its compensation was switched off: 0.3 s.
constexpr std::int64_t kTicksToShedWeight = 1200;
/// If force is not on after this many ticks, it waits for a person: 0.25 s.
constexpr std::int64_t kTicksToSwitchOn = 1000;
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

Loop::Loop(const Api& api, char device, std::optional<double> max_weight_n, Now now)
    : api_(api), device_(device), max_weight_n_(max_weight_n), now_(now) {
  check_status();  // so that readiness() is right from the start
  thread_ = std::thread([this] { run(); });
}

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
  switch_off();
}

void Loop::tick() noexcept {
  if (tick_ >= status_at_) check_status();
  switch_force();
  take_sample();
  const Vec3 force_n = link_.force_to_send(monotonic_now());
  send(may_push() ? force_n : Vec3{});
  ++tick_;
}

void Loop::check_status() noexcept {
  status_at_ = tick_ + kTicksBetweenStatus;
  Status status{};
  if (api_.get_status(status.data(), device_) < 0 || status[kConnected] == 0) {
    link_.fail(DeviceFault::link_lost);
    return;
  }
  if (status[kError] != 0) link_.fail(DeviceFault::driver);
  calibrated_ = is_calibrated(api_, status, device_);
  note_force(status[kForce] != 0, status[kForceOffCause]);
  readiness_.store(need(), std::memory_order_release);
}

/// The cause is that of the last switch-off, which may be old, so it counts only after force was
/// seen on. A person may switch force off at the device, which is not a fault.
void Loop::note_force(bool is_on, int cause) noexcept {
  const bool lost = force_on_ && !is_on;
  force_on_ = is_on && switched_on_;
  was_on_ = was_on_ || force_on_;
  if (!lost) return;
  if (cause == kOffByVelocity) link_.fail(DeviceFault::limit_passed);
  if (cause == kOffByWatchdog) link_.fail(DeviceFault::driver);
  if (cause == kOffByUnplugging) link_.fail(DeviceFault::link_lost);
}

DeviceReadiness Loop::need() const noexcept {
  if (!calibrated_) return DeviceReadiness::needs_calibration;
  const bool should_be_on = switched_on_ && (was_on_ || tick_ - switched_at_ >= kTicksToSwitchOn);
  return should_be_on && !force_on_ ? DeviceReadiness::needs_force_on : DeviceReadiness::ready;
}

/// After a halt or a fault, or while the device is not calibrated, force is off and the brakes are
/// on. A force of zero would not suffice, because the library adds the weight to it.
void Loop::switch_force() noexcept {
  const bool is_shed = max_weight_n_ || tick_ >= kTicksToShedWeight;
  const bool may_be_on = calibrated_ && is_shed && !link_.is_stopped();
  if (may_be_on == switched_on_) return;
  if (!may_be_on) {
    switch_off();
    return;
  }
  if (!is_weight_plausible()) {
    link_.fail(DeviceFault::bad_data);
    return;
  }
  // In ticks with force off the last force is zero.
  if (api_.enable_force(1, device_) < 0) {
    fail_call();
    return;
  }
  switched_on_ = true;
  was_on_ = false;
  switched_at_ = tick_;
  status_at_ = tick_ + 1;
}

void Loop::switch_off() noexcept {
  const int result = api_.stop != nullptr ? api_.stop(device_) : api_.enable_force(0, device_);
  switched_on_ = force_on_ = was_on_ = false;
  if (result < 0 && !closing_.load(std::memory_order_acquire)) fail_call();
}

bool Loop::is_weight_plausible() const noexcept {
  if (!max_weight_n_) return true;
  const std::optional<Vec3> weight_n = added_weight_n(api_, device_);
  return !weight_n || is_plausible_weight(*weight_n, *max_weight_n_);
}

void Loop::take_sample() noexcept {
  Vec3 position_m;
  const int got = api_.get_position(&position_m.x, &position_m.y, &position_m.z, device_);
  const Time at = now_();
  if (got < 0) {
    fail_call();
    return;
  }
  if (!is_finite(position_m)) {
    link_.fail(DeviceFault::bad_data);
    return;
  }
  if (got == kTimeGuard && !exchanged_) return;  // the servo sees it by the sequence number
  exchanged_ = false;
  // Calibration moves the origin, so earlier positions must not enter velocities.
  if (!calibrated_) velocity_.forget();
  DeviceSample sample;
  sample.position_mm = kMmPerM * to_device_frame(position_m);
  sample.velocity_mm_s = velocity_.add(sample.position_mm, at);
  sample.buttons = api_.get_button_mask(device_);
  sample.ready = may_push();
  sample.limited = saturated_;
  link_.publish(sample);
}

void Loop::send(Vec3 force_n) noexcept {
  const Vec3 force = to_dhd_frame(force_n);
  const int result = api_.set_force(force.x, force.y, force.z, device_);
  exchanged_ = exchanged_ || (result >= 0 && result != kTimeGuard);
  saturated_ = result == kMotorSaturated;
  if (result < 0) fail_call();
}

/// Reports a failed call: the device was disconnected, or the library gives another reason.
void Loop::fail_call() noexcept {
  Status status{};
  const bool there = api_.get_status(status.data(), device_) >= 0 && status[kConnected] != 0;
  link_.fail(there ? DeviceFault::driver : DeviceFault::link_lost);
}

}  // namespace touchtrial::device::dhd
