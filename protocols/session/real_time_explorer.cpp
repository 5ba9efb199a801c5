#include "protocols/session/real_time_explorer.hpp"

#include "device/platform/stop_signals.hpp"
#include "device/servo/flight_recorder.hpp"
#include "device/servo/paced_clock.hpp"
#include "device/servo/running_servo.hpp"
#include "device/servo/sample_ring.hpp"
#include "device/servo/servo_thread.hpp"
#include "protocols/session/interruption_words.hpp"
#include "protocols/session/model_force.hpp"
#include "protocols/session/trace_writer.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>

namespace touchtrial::session {
namespace {

/// How long the session's thread waits for the servo's end before it looks after the participant
/// again.
constexpr std::chrono::milliseconds kBetweenLooks{5};

/// A writer that is late by this many samples loses some: 6.5 s at 10 kHz.
constexpr std::size_t kLargestRing = std::size_t{1} << 16U;

store::ServoHealth health_of(const device::ServoReport& report, std::int64_t lost,
                             std::int64_t held) {
  return {.rate_hz = report.rate_hz,
          .lateness_p50_us = report.lateness.p50_us,
          .lateness_p99_us = report.lateness.p99_us,
          .lateness_p999_us = report.lateness.p999_us,
          .lateness_worst_us = report.lateness.worst_us,
          .lost = lost,
          .held = held};
}

}  // namespace

struct RealTimeExplorer::Machinery {
  explicit Machinery(const RealTimeOptions& wanted) : options(wanted), thread(wanted.scheduling) {}

  [[nodiscard]] std::unique_ptr<device::ServoClock> make_clock() const {
    if (options.clock) return options.clock();
    return std::make_unique<device::PacedClock>(
        device::PacedClock::usual_spin(thread.scheduling().policy));
  }

  /// Takes memory that the servo will use before it runs.
  void make_room(const device::ServoOptions& servo) {
    const std::size_t wanted = std::clamp(most_samples(servo), std::size_t{1}, kLargestRing);
    if (!ring || ring->capacity() < wanted) ring.emplace(wanted);
    if (!recorder || recorder_rate_hz != servo.rate_hz) {
      recorder.emplace(options.flight_s, servo.rate_hz);
      recorder_rate_hz = servo.rate_hz;
    }
    recorder->clear();
  }

  /// One run of the servo, on its thread; this one looks after the participant meanwhile.
  /// \param began  set to when the servo starts
  [[nodiscard]] device::ServoReport run(device::HapticDevice& device,
                                        const engine::RenderingModel& model,
                                        device::SampleSink& sink, const device::ServoOptions& servo,
                                        Participant& participant,
                                        std::chrono::steady_clock::time_point& began);

  RealTimeOptions options;
  device::ServoControl control;
  std::atomic<std::int64_t> heartbeat{device::kServoAtRest};
  device::MotorHeat heat;
  std::optional<device::SampleRing> ring;
  std::optional<device::FlightRecorder> recorder;
  double recorder_rate_hz = 0.0;
  device::ServoThread thread;
};

device::ServoReport RealTimeExplorer::Machinery::run(device::HapticDevice& device,
                                                     const engine::RenderingModel& model,
                                                     device::SampleSink& sink,
                                                     const device::ServoOptions& servo,
                                                     Participant& participant,
                                                     std::chrono::steady_clock::time_point& began) {
  control.forget_wishes();
  ModelForce force(model);
  const std::unique_ptr<device::ServoClock> clock = make_clock();
  device::ServoHooks hooks;
  hooks.control = &control;
  hooks.heartbeat = &heartbeat;
  hooks.recorder = &*recorder;
  hooks.heat = &heat;
  const device::StopOnSignals signals(device, control);
  device::Watchdog watchdog(device, control, heartbeat,
                            device::Watchdog::silence_for(device.info()), *options.watchdog_time);
  watchdog.arm();
  device::ServoReport report;
  device::RunningServo running(thread, control, [&] {
    began = std::chrono::steady_clock::now();
    report = device::run_servo(device, force, sink, servo, *clock, hooks);
  });
  while (running.runs(kBetweenLooks)) participant.exploring(control);
  running.finish();
  if (watchdog.disarm() && !is_interrupted(report)) {
    // It tripped while the run ended by itself: the device is halted, which is an interruption.
    report.end = device::ServoEnd::fault;
    report.fault = device::SafetyFault::stalled;
  }
  if (is_interrupted(report)) {
    device.halt();
    control.reset();
  }
  return report;
}

RealTimeExplorer::RealTimeExplorer(const RealTimeOptions& options)
    : machinery_(std::make_unique<Machinery>(options)) {}

RealTimeExplorer::~RealTimeExplorer() = default;

const device::SchedulingObtained& RealTimeExplorer::scheduling() const noexcept {
  return machinery_->thread.scheduling();
}

device::ServoControl& RealTimeExplorer::control() noexcept {
  return machinery_->control;
}

Exploration RealTimeExplorer::explore(const engine::RenderingModel& model,
                                      const PlaneGeometry& plane, Participant& participant,
                                      const device::ServoOptions& options, store::Trace& trace) {
  Machinery& m = *machinery_;
  m.make_room(options);
  device::HapticDevice& device = participant.begin_exploring(plane);
  TraceBuilder builder(trace, options.rate_hz, most_samples(options));
  device::RingSink sink(*m.ring);
  Exploration done;
  {
    const TraceWriter writer(*m.ring, builder, participant);
    done.servo = m.run(device, model, sink, options, participant, done.began.emplace());
  }
  done.landed_at = builder.landed_at();
  done.lasted = time_of_tick(done.servo.ticks + done.servo.overruns, options.rate_hz);
  done.held_in_contact = builder.held_in_contact();
  done.health = health_of(done.servo, sink.dropped(), builder.held());
  if (is_interrupted(done.servo)) done.detail = detail_of(done.servo, m.recorder->ticks());
  return done;
}

}  // namespace touchtrial::session
