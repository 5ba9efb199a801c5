#include "protocols/session/exploration.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::session {
namespace {

/// Adds samples to the trace, and lets the participant feel them.
class TrialSink final : public device::SampleSink {
 public:
  TrialSink(Participant& participant, TraceBuilder& builder)
      : participant_(participant), builder_(builder) {}

  void record(const device::ServoSample& sample) noexcept override {
    builder_.add(sample);
    participant_.feel(sample);
  }

 private:
  Participant& participant_;
  TraceBuilder& builder_;
};

}  // namespace

device::ServoOptions trial_servo_options(const study::Study& study, double rate_hz,
                                         const device::LabLimits& lab) {
  device::ServoOptions options;
  options.rate_hz = rate_hz;
  options.limit_ticks = std::llround(study.trials.explore_limit_s * rate_hz);
  options.fade_ticks = std::llround(std::chrono::duration<double>(study::kFade).count() * rate_hz);
  options.limits.max_force_n = study.rendering.max_force_n;
  options.limits = device::stricter_of(options.limits, lab);
  return options;
}

std::size_t max_samples(const device::ServoOptions& options) noexcept {
  return static_cast<std::size_t>(options.limit_ticks + options.fade_ticks);
}

std::chrono::nanoseconds time_of_tick(std::int64_t tick, double rate_hz) noexcept {
  constexpr double kNanosecondsPerS = 1e9;
  return std::chrono::nanoseconds(
      std::llround(static_cast<double>(tick) * kNanosecondsPerS / rate_hz));
}

TraceBuilder::TraceBuilder(record::Trace& trace, double rate_hz, std::size_t max_samples)
    : trace_(trace), capacity_(max_samples) {
  trace.rate_hz = rate_hz;
  trace.samples.clear();
  trace.samples.reserve(max_samples);
}

/// If there is no sample to hold yet, the first one fills the gap.
void TraceBuilder::hold_until(std::size_t tick, const record::TraceSample& first) noexcept {
  const record::TraceSample held_sample = trace_.samples.empty() ? first : trace_.samples.back();
  while (trace_.samples.size() < tick) {
    trace_.samples.push_back(held_sample);
    ++held_;
    held_in_contact_ += held_sample.force_n.z > 0.0 ? 1 : 0;
  }
}

std::optional<std::chrono::nanoseconds> TraceBuilder::landed_at() const noexcept {
  if (!landing_tick_) return std::nullopt;
  return time_of_tick(*landing_tick_, trace_.rate_hz);
}

bool is_interrupted(const device::ServoReport& report) noexcept {
  return report.end == device::ServoEnd::fault || report.end == device::ServoEnd::comfort_stop;
}

std::string public_reason(const device::ServoReport& report) {
  if (report.end == device::ServoEnd::comfort_stop) return "comfort stop";
  if (report.fault == device::SafetyFault::emergency_stop) return "emergency stop";
  if (report.device_fault == device::DeviceFault::link_lost) return "device lost";
  return "device fault";
}

Exploration VirtualExplorer::explore(device::ForceSource& force, const PlaneGeometry& plane,
                                     Participant& participant, const device::ServoOptions& options,
                                     record::Trace& trace) {
  TraceBuilder builder(trace, options.rate_hz, max_samples(options));
  device::HapticDevice& device = participant.begin_exploring(plane);
  TrialSink sink(participant, builder);
  Exploration exploration;
  exploration.servo = device::run_servo_in_virtual_time(device, force, sink, options);
  exploration.landed_at = builder.landed_at();
  exploration.duration = time_of_tick(exploration.servo.ticks, options.rate_hz);
  return exploration;
}

}  // namespace touchtrial::session
