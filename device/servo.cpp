#include "device/servo.hpp"

#include "device/safety.hpp"

#include <algorithm>
#include <optional>

namespace touchtrial {
namespace {

/// 1 until time is up, then falling to 0 over the fade.
double fade_at(std::int64_t tick, const ServoOptions& options) noexcept {
  if (tick < options.limit_ticks) return 1.0;
  const auto faded = static_cast<double>(tick + 1 - options.limit_ticks);
  return 1.0 - faded / static_cast<double>(options.fade_ticks);
}

/// One tick. \return why the loop must end, or nothing
std::optional<ServoEnd> run_tick(HapticDevice& device, ForceSource& force, SampleSink& sink,
                                 SafetyChain& safety, double fade, ServoReport& report) noexcept {
  DeviceSample sample;
  const DeviceStatus state = device.read(sample);
  if (state == DeviceStatus::stopped) return ServoEnd::hand_stopped;
  if (state == DeviceStatus::fault) return ServoEnd::fault;
  const SafeForce safe = safety.check(fade * force.force_n(sample));
  if (safe.verdict == SafetyVerdict::fault) return ServoEnd::fault;
  if (safe.verdict == SafetyVerdict::limited) ++report.limited_ticks;
  if (device.write(safe.force_n) != DeviceStatus::ok) return ServoEnd::fault;
  sink.record({sample.position_mm, safe.force_n});
  ++report.ticks;
  return std::nullopt;
}

}  // namespace

ServoReport run_servo_in_virtual_time(HapticDevice& device, ForceSource& force, SampleSink& sink,
                                      const ServoOptions& options) {
  ServoReport report;
  report.force_limit_n = std::min(options.max_force_n, device.info().max_force_n);
  SafetyChain safety(report.force_limit_n);
  std::optional<ServoEnd> end;
  const std::int64_t last = options.limit_ticks + options.fade_ticks;
  for (std::int64_t tick = 0; tick < last && !end; ++tick) {
    end = run_tick(device, force, sink, safety, fade_at(tick, options), report);
  }
  // The loop has ended either way; a device that is lost cannot take the zero either.
  static_cast<void>(device.write({}));
  report.end = end.value_or(ServoEnd::time_limit);
  return report;
}

}  // namespace touchtrial
