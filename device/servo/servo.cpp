#include "device/servo/servo.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace touchtrial {
namespace {

/// One run of the loop.
class ServoRun {
 public:
  ServoRun(HapticDevice& device, ForceSource& force, SampleSink& sink, const ServoOptions& options,
           const ServoHooks& hooks)
      : device_(device),
        force_(force),
        sink_(sink),
        options_(options),
        hooks_(hooks),
        safety_(limits_of(options, device.info()), 1.0 / options.rate_hz),
        fade_from_(options.limit_ticks),
        fade_ticks_(options.fade_ticks) {
    report_.force_limit_n = limits_of(options, device.info()).max_force_n;
    report_.rate_hz = options.rate_hz;
  }

  ServoReport run(ServoClock& clock) noexcept {
    const ServoClock::Time first = clock.now();
    std::optional<ServoEnd> end;
    for (std::int64_t tick = 0; tick < fade_from_ + fade_ticks_ && !end; ++tick) {
      clock.wait_until(first + time_of(tick));
      take_requests(tick);
      end = run_tick(tick);
      if (hooks_.heartbeat != nullptr) hooks_.heartbeat->fetch_add(1, std::memory_order_release);
    }
    // The loop has ended either way; a device that is lost cannot take the zero either.
    static_cast<void>(device_.write({}));
    report_.end = end.value_or(end_of_fade_);
    report_.fault = safety_.fault();
    report_.device_fault = device_.fault();
    return report_;
  }

 private:
  static SafetyLimits limits_of(const ServoOptions& options, const DeviceInfo& device) {
    SafetyLimits limits = options.limits;
    limits.max_force_n = std::min(limits.max_force_n, device.max_force_n);
    return limits;
  }

  ServoClock::Time time_of(std::int64_t tick) const noexcept {
    return ServoClock::Time(std::llround(static_cast<double>(tick) * 1e9 / options_.rate_hz));
  }

  void take_requests(std::int64_t tick) noexcept {
    if (hooks_.control == nullptr) return;
    if (hooks_.control->emergency_stop_asked()) safety_.trip(SafetyFault::emergency_stop);
    if (hooks_.control->comfort_stop_asked()) fade_out(tick, ServoEnd::comfort_stop);
    if (hooks_.control->finish_asked()) fade_out(tick, ServoEnd::hand_stopped);
  }

  /// Begins the fade now, if none has begun.
  void fade_out(std::int64_t tick, ServoEnd end) noexcept {
    if (tick >= fade_from_) return;
    fade_from_ = tick;
    end_of_fade_ = end;
  }

  /// 1 until the fade begins, then falling to 0.
  double fade_at(std::int64_t tick) const noexcept {
    if (tick < fade_from_) return 1.0;
    return 1.0 - static_cast<double>(tick + 1 - fade_from_) / static_cast<double>(fade_ticks_);
  }

  /// \return why the loop must end, or nothing
  std::optional<ServoEnd> run_tick(std::int64_t tick) noexcept {
    DeviceSample sample;
    const DeviceStatus state = device_.read(sample);
    if (state == DeviceStatus::stopped) return ServoEnd::hand_stopped;
    if (state == DeviceStatus::fault) safety_.trip(SafetyFault::device);
    const SafeForce safe = safety_.check(fade_at(tick) * force_.force_n(sample), sample);
    if (safe.verdict == SafetyVerdict::fault) return ServoEnd::fault;
    if (safe.verdict == SafetyVerdict::limited) ++report_.limited_ticks;
    if (device_.write(safe.force_n) != DeviceStatus::ok) {
      safety_.trip(SafetyFault::device);
      return ServoEnd::fault;
    }
    sink_.record({sample.position_mm, safe.force_n, tick});
    ++report_.ticks;
    report_.contact_ticks += safe.force_n.z > 0.0 ? 1 : 0;
    if (hooks_.state != nullptr) hooks_.state->set({sample, safe.force_n, safe.verdict, tick, 0.0});
    return std::nullopt;
  }

  HapticDevice& device_;
  ForceSource& force_;
  SampleSink& sink_;
  const ServoOptions& options_;
  const ServoHooks& hooks_;
  SafetyChain safety_;
  std::int64_t fade_from_;
  std::int64_t fade_ticks_;
  ServoEnd end_of_fade_ = ServoEnd::time_limit;
  ServoReport report_;
};

}  // namespace

ServoReport run_servo(HapticDevice& device, ForceSource& force, SampleSink& sink,
                      const ServoOptions& options, ServoClock& clock, const ServoHooks& hooks) {
  return ServoRun(device, force, sink, options, hooks).run(clock);
}

ServoReport run_servo_in_virtual_time(HapticDevice& device, ForceSource& force, SampleSink& sink,
                                      const ServoOptions& options) {
  VirtualClock clock;
  return run_servo(device, force, sink, options, clock);
}

}  // namespace touchtrial
