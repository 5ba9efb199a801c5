#include "device/drivers/openhaptics/hd_loop.hpp"

#include "device/platform/realtime.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <thread>

namespace touchtrial::device::hd {
namespace {

/// A bound, in case the library never runs out of errors.
constexpr int kMaxErrors = 256;

DeviceFault fault_of(std::uint32_t code) noexcept {
  switch (code) {
    case 0:
      return DeviceFault::none;
    case kWarmMotors:
      return DeviceFault::warm_motors;
    case kExceededForce:
    case kExceededImpulse:
    case kExceededVelocity:
      return DeviceFault::limit_passed;
    case kCommunicationError:
      return DeviceFault::link_lost;
    default:
      return DeviceFault::driver;
  }
}

constexpr std::int64_t kTicksBetweenTemperatures = 100;
/// Calibration takes a moment; a new request during it would restart it.
constexpr std::int64_t kTicksBetweenCalibrations = 100;

/// The action that a calibration style requires of a person.
DeviceReadiness required_action_of(int style) noexcept {
  switch (style) {
    case kStyleEncoderReset:
      return DeviceReadiness::needs_reset;
    case kStyleAuto:
      return DeviceReadiness::needs_homing;
    case kStyleInkwell:
      return DeviceReadiness::needs_inkwell;
    default:
      return DeviceReadiness::needs_calibration;
  }
}

Vec3 vec_from(const std::array<double, 3>& values) noexcept {
  return {values[0], values[1], values[2]};
}

}  // namespace

Api load_api(const DynamicLibrary& library) {
  Api api{};
  library.find("hdInitDevice", api.init_device);
  library.find("hdDisableDevice", api.disable_device);
  library.find("hdMakeCurrentDevice", api.make_current_device);
  library.find("hdBeginFrame", api.begin_frame);
  library.find("hdEndFrame", api.end_frame);
  library.find("hdEnable", api.enable);
  library.find("hdDisable", api.disable);
  library.find("hdGetDoublev", api.get_doublev);
  library.find("hdGetIntegerv", api.get_integerv);
  library.find("hdSetDoublev", api.set_doublev);
  library.find("hdGetString", api.get_string);
  library.find("hdGetErrorString", api.get_error_string);
  library.find("hdGetError", api.get_error);
  library.find("hdCheckCalibration", api.check_calibration);
  library.find("hdUpdateCalibration", api.update_calibration);
  library.find("hdStartScheduler", api.start_scheduler);
  library.find("hdStopScheduler", api.stop_scheduler);
  library.find("hdSetSchedulerRate", api.set_scheduler_rate);
  library.find("hdScheduleAsynchronous", api.schedule_asynchronous);
  library.find("hdUnschedule", api.unschedule);
  return api;
}

Errors drain_errors(const Api& api) noexcept {
  Errors errors;
  for (int i = 0; i < kMaxErrors; ++i) {
    const std::uint32_t code = api.get_error().code;
    if (code == 0) break;
    errors.oldest = code;
    const bool is_specific =
        errors.fault != DeviceFault::none && errors.fault != DeviceFault::driver;
    if (!is_specific) errors.fault = fault_of(code);
  }
  return errors;
}

std::uint32_t Loop::callback(void* loop) noexcept {
  return static_cast<Loop*>(loop)->run_callback();
}

/// Sets `in_callback_` before it reads `closed_`, while `close` sets `closed_` before it reads
/// `in_callback_`: with sequentially consistent atomics at least one of them sees the other's
/// value.
std::uint32_t Loop::run_callback() noexcept {
  in_callback_.store(true);
  const bool is_closed = closed_.load();
  if (!is_closed) tick();
  in_callback_.store(false);
  return is_closed ? kCallbackDone : kCallbackContinue;
}

bool Loop::close(std::chrono::milliseconds timeout) noexcept {
  closed_.store(true);
  for (auto waited = std::chrono::milliseconds(0); in_callback_.load(); ++waited) {
    if (waited >= timeout) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

void Loop::tick() noexcept {
  api_.make_current_device(device_);
  check_calibration();
  run_frame();
  const Errors errors = drain_errors(api_);
  if (errors.fault != DeviceFault::none) link_.fail(errors.fault);
  ++tick_;
}

/// The position of a calibrated device stays valid while a calibration update is pending.
void Loop::check_calibration() noexcept {
  const Enum state = api_.check_calibration();
  if (state == kCalibrationOk) is_calibrated_ = true;
  if (state != kCalibrationOk && state != kCalibrationNeedsUpdate) is_calibrated_ = false;
  if (is_update_due(state)) {
    api_.update_calibration(static_cast<Enum>(options_.calibration_style));
    // A failed calibration is retried.
    const DeviceFault fault = drain_errors(api_).fault;
    if (fault != DeviceFault::none && fault != DeviceFault::driver) link_.fail(fault);
  }
  readiness_.store(
      is_calibrated_ ? DeviceReadiness::ready : required_action_of(options_.calibration_style),
      std::memory_order_release);
}

/// An update moves the origin, so it waits until no servo renders forces. A reset makes the arm's
/// current position the reset position, so a person must request it.
bool Loop::is_update_due(Enum state) noexcept {
  const bool is_requested = reset_requested_.exchange(false, std::memory_order_acq_rel);
  if (options_.calibration_style == kStyleEncoderReset) return is_requested && !is_calibrated_;
  idle_ticks_ = link_.live_force(monotonic_now()) ? 0 : idle_ticks_ + 1;
  return options_.calibration_style != 0 && state == kCalibrationNeedsUpdate &&
         tick_ % kTicksBetweenCalibrations == 0 &&
         (!is_calibrated_ || idle_ticks_ > kTicksBetweenCalibrations);
}

void Loop::run_frame() noexcept {
  api_.begin_frame(device_);
  DeviceSample sample = read_sample();
  sample.ready = is_calibrated_;
  if (tick_ % kTicksBetweenTemperatures == 0) check_temperature();
  if (!is_finite(sample.position_mm) || !is_finite(sample.velocity_mm_s)) {
    link_.fail(DeviceFault::bad_data);
  } else {
    link_.publish(sample);
  }
  const Vec3 force_n = link_.force_to_send(monotonic_now());
  send(is_calibrated_ ? force_n : Vec3{});
  api_.end_frame(device_);
}

DeviceSample Loop::read_sample() noexcept {
  std::array<double, 3> position{};
  std::array<double, 3> velocity{};
  int buttons = 0;
  api_.get_doublev(kPosition, position.data());
  api_.get_doublev(kVelocity, velocity.data());
  api_.get_integerv(kButtons, &buttons);
  return {vec_from(position), vec_from(velocity), 0, static_cast<std::uint32_t>(buttons)};
}

void Loop::check_temperature() noexcept {
  if (!options_.has_motor_temperature) return;
  std::array<double, 6> temperatures{};
  api_.get_doublev(kMotorTemperature, temperatures.data());
  const bool is_warm = std::any_of(temperatures.begin(), temperatures.end(),
                                   [](double motor) { return motor > kMaxMotorTemperature; });
  if (is_warm) link_.fail(DeviceFault::warm_motors);
}

void Loop::send(Vec3 force_n) noexcept {
  const std::array<double, 3> force = {force_n.x, force_n.y, force_n.z};
  api_.set_doublev(kCurrentForce, force.data());
  const bool is_zero = force_n == Vec3{};
  zeros_sent_.store(
      is_zero ? std::min(zeros_sent_.load(std::memory_order_relaxed) + 1, 1'000'000) : 0,
      std::memory_order_release);
}

}  // namespace touchtrial::device::hd
