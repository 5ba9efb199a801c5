#include "device/drivers/dhd/dhd_loop.hpp"

#include "device/drivers/dhd/dhd_gravity.hpp"
#include "device/platform/realtime.hpp"

#include <algorithm>

namespace touchtrial::device::dhd {
namespace {

constexpr std::chrono::nanoseconds kPeriod{static_cast<std::int64_t>(1e9 / kPollRateHz)};
constexpr std::int64_t kTicksBetweenStatus = 40;
/// 0.3 s. The library removes the weight within 250 ms after compensation is switched off.
constexpr std::int64_t kTicksToRemoveWeight = 1200;
/// 0.25 s. If force is not on by then, a person must switch it on.
constexpr std::int64_t kTicksToSwitchOn = 1000;
constexpr int kClosingZeros = 5;
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
  check_status();  // so that readiness() is valid from the start
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
  for (int i = 0; i < kClosingZeros; ++i) (void)api_.set_force(0.0, 0.0, 0.0, device_);
  switch_off();
}

void Loop::tick() noexcept {
  if (tick_ >= next_status_) check_status();
  update_force_switch();
  publish_sample();
  const Vec3 force_n = link_.force_to_send(monotonic_now());
  send(is_force_allowed() ? force_n : Vec3{});
  ++tick_;
}

void Loop::check_status() noexcept {
  next_status_ = tick_ + kTicksBetweenStatus;
  Status status{};
  if (api_.get_status(status.data(), device_) < 0 || status[kConnected] == 0) {
    link_.fail(DeviceFault::link_lost);
    return;
  }
  if (status[kError] != 0) link_.fail(DeviceFault::driver);
  is_calibrated_ = is_calibrated(api_, status, device_);
  update_force_state(status[kForce] != 0, status[kForceOffCause]);
  readiness_.store(required_action(), std::memory_order_release);
}

/// The reported cause may belong to an earlier switch-off, so it counts only if force was on
/// before. A person may switch force off at the device, which is not a fault.
void Loop::update_force_state(bool is_on, int cause) noexcept {
  const bool has_switched_off = is_force_on_ && !is_on;
  is_force_on_ = is_on && is_force_requested_;
  was_force_on_ = was_force_on_ || is_force_on_;
  if (!has_switched_off) return;
  if (cause == kOffByVelocity) link_.fail(DeviceFault::limit_passed);
  if (cause == kOffByWatchdog) link_.fail(DeviceFault::driver);
  if (cause == kOffByUnplugging) link_.fail(DeviceFault::link_lost);
}

DeviceReadiness Loop::required_action() const noexcept {
  if (!is_calibrated_) return DeviceReadiness::needs_calibration;
  const bool should_be_on =
      is_force_requested_ && (was_force_on_ || tick_ - requested_at_ >= kTicksToSwitchOn);
  return should_be_on && !is_force_on_ ? DeviceReadiness::needs_force_on : DeviceReadiness::ready;
}

/// Switches force off and the brakes on after a halt or a fault, or while the device is not
/// calibrated. A force of zero would not suffice, because the library adds the weight to it.
void Loop::update_force_switch() noexcept {
  const bool is_weight_removed = max_weight_n_ || tick_ >= kTicksToRemoveWeight;
  const bool may_be_on = is_calibrated_ && is_weight_removed && !link_.is_stopped();
  if (may_be_on == is_force_requested_) return;
  if (!may_be_on) {
    switch_off();
    return;
  }
  if (!is_weight_plausible()) {
    link_.fail(DeviceFault::bad_data);
    return;
  }
  // The last force is zero, because ticks with force off send zero.
  if (api_.enable_force(1, device_) < 0) {
    report_failed_call();
    return;
  }
  is_force_requested_ = true;
  was_force_on_ = false;
  requested_at_ = tick_;
  next_status_ = tick_ + 1;
}

void Loop::switch_off() noexcept {
  const int result = api_.stop != nullptr ? api_.stop(device_) : api_.enable_force(0, device_);
  is_force_requested_ = is_force_on_ = was_force_on_ = false;
  if (result < 0 && !closing_.load(std::memory_order_acquire)) report_failed_call();
}

bool Loop::is_weight_plausible() const noexcept {
  if (!max_weight_n_) return true;
  const std::optional<Vec3> weight_n = compensated_weight_n(api_, device_);
  return !weight_n || is_plausible_weight(*weight_n, *max_weight_n_);
}

void Loop::publish_sample() noexcept {
  Vec3 position_m;
  const int result = api_.get_position(&position_m.x, &position_m.y, &position_m.z, device_);
  const Time time = now_();
  if (result < 0) {
    report_failed_call();
    return;
  }
  if (!is_finite(position_m)) {
    link_.fail(DeviceFault::bad_data);
    return;
  }
  if (result == kTimeGuard && !has_exchanged_) return;  // no new reading
  has_exchanged_ = false;
  // Calibration moves the origin, so earlier positions must not enter velocities.
  if (!is_calibrated_) velocity_.reset();
  DeviceSample sample;
  sample.position_mm = kMmPerM * to_device_frame(position_m);
  sample.velocity_mm_s = velocity_.add(sample.position_mm, time);
  sample.buttons = api_.get_button_mask(device_);
  sample.ready = is_force_allowed();
  sample.limited = is_saturated_;
  link_.publish(sample);
}

void Loop::send(Vec3 force_n) noexcept {
  const Vec3 force = to_dhd_frame(force_n);
  const int result = api_.set_force(force.x, force.y, force.z, device_);
  has_exchanged_ = has_exchanged_ || (result >= 0 && result != kTimeGuard);
  is_saturated_ = result == kMotorSaturated;
  if (result < 0) report_failed_call();
}

/// Reports a failed call as a lost link or, if the device is still connected, a driver fault.
void Loop::report_failed_call() noexcept {
  Status status{};
  const bool is_connected = api_.get_status(status.data(), device_) >= 0 && status[kConnected] != 0;
  link_.fail(is_connected ? DeviceFault::driver : DeviceFault::link_lost);
}

}  // namespace touchtrial::device::dhd
