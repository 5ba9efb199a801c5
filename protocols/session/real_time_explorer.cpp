#include "protocols/session/real_time_explorer.hpp"

#include "device/platform/stop_signals.hpp"
#include "device/servo/flight_recorder.hpp"
#include "device/servo/sample_ring.hpp"
#include "device/servo/servo_clock.hpp"
#include "device/servo/servo_thread.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace touchtrial::session {
namespace {

/// The interval at which the session's thread polls the participant while the servo runs.
constexpr std::chrono::milliseconds kPollInterval{5};

/// Maximum capacity of the ring, samples: 6.5 s at 10 kHz. A writer that falls further behind loses
/// samples.
constexpr std::size_t kMaxRing = std::size_t{1} << 16U;

// The writer polls, because the servo must not spend time waking it.
constexpr std::chrono::milliseconds kDrainInterval{2};
constexpr std::size_t kBatchSize = 256;

/// A thread that drains the servo's ring while the servo fills it, and passes the samples to the
/// trace and the participant. Constructed and destroyed on the same thread.
class TraceWriter {
 public:
  /// All arguments must outlive this. Meanwhile, nothing else may use `builder` or call
  /// Participant::feel.
  TraceWriter(device::SampleRing& ring, TraceBuilder& builder, Participant& participant)
      : ring_(ring), builder_(builder), participant_(participant), thread_([this] { write(); }) {}
  /// Drains the ring. The servo must have ended.
  ~TraceWriter() {
    finishing_.store(true, std::memory_order_release);
    thread_.join();
  }
  TraceWriter(const TraceWriter&) = delete;
  TraceWriter& operator=(const TraceWriter&) = delete;

 private:
  void write() noexcept {
    while (!finishing_.load(std::memory_order_acquire)) {
      if (!drain_ring()) std::this_thread::sleep_for(kDrainInterval);
    }
    while (drain_ring()) {
    }
  }

  /// \return whether there was a sample
  bool drain_ring() noexcept {
    std::array<device::ServoSample, kBatchSize> samples;
    const std::size_t count = ring_.pop(samples);
    for (const device::ServoSample& sample : std::span(samples).first(count)) {
      builder_.add(sample);
      participant_.feel(sample);
    }
    return count > 0;
  }

  device::SampleRing& ring_;
  TraceBuilder& builder_;
  Participant& participant_;
  std::atomic<bool> finishing_{false};
  std::thread thread_;
};

record::ServoHealth health_of(const device::ServoReport& report, std::int64_t lost,
                              std::int64_t held) {
  return {.rate_hz = report.rate_hz,
          .lateness_p50_us = report.lateness.p50_us,
          .lateness_p99_us = report.lateness.p99_us,
          .lateness_p999_us = report.lateness.p999_us,
          .lateness_worst_us = report.lateness.worst_us,
          .lost = lost,
          .held = held};
}

/// The sealed part of an interruption: the faults by name, and the ticks before them.
record::InterruptionDetail detail_of(const device::ServoReport& report,
                                     const std::vector<device::FlightTick>& ticks) {
  double max_n = 0.0;
  for (const device::FlightTick& tick : ticks) max_n = std::max(max_n, norm(tick.sent_n));
  return {.safety_fault = std::string(device::name_of(report.fault)),
          .device_fault = std::string(device::name_of(report.device_fault)),
          .ticks = static_cast<std::int64_t>(ticks.size()),
          .flight = device::flight_csv(ticks),
          .largest_force_n = max_n};
}

}  // namespace

struct RealTimeExplorer::Impl {
  explicit Impl(const RealTimeOptions& requested)
      : options(requested), thread(requested.scheduling) {}

  [[nodiscard]] std::unique_ptr<device::ServoClock> make_clock() const {
    if (options.clock) return options.clock();
    return std::make_unique<device::PacedClock>(
        device::PacedClock::default_spin(thread.scheduling().policy));
  }

  /// Allocates the servo's memory before it runs.
  void allocate(const device::ServoOptions& servo) {
    const std::size_t capacity = std::clamp(max_samples(servo), std::size_t{1}, kMaxRing);
    if (!ring || ring->capacity() < capacity) ring.emplace(capacity);
    if (!recorder || recorder_rate_hz != servo.rate_hz) {
      recorder.emplace(options.flight_s, servo.rate_hz);
      recorder_rate_hz = servo.rate_hz;
    }
    recorder->clear();
  }

  /// Runs the servo on its thread while the caller's thread polls the participant.
  /// \param began  set to the time at which the servo starts
  [[nodiscard]] device::ServoReport run(device::HapticDevice& device, device::ForceSource& force,
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

device::ServoReport RealTimeExplorer::Impl::run(device::HapticDevice& device,
                                                device::ForceSource& force,
                                                device::SampleSink& sink,
                                                const device::ServoOptions& servo,
                                                Participant& participant,
                                                std::chrono::steady_clock::time_point& began) {
  control.clear_requests();
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
    participant.note_plane_on(began);
    report = device::run_servo(device, force, sink, servo, *clock, hooks);
  });
  while (running.is_running(kPollInterval)) participant.while_exploring(control);
  running.finish();
  if (watchdog.disarm() && !is_interrupted(report)) {
    // The watchdog tripped just as the run ended. It has halted the device, so this counts as an
    // interruption.
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
    : impl_(std::make_unique<Impl>(options)) {}

RealTimeExplorer::~RealTimeExplorer() = default;

const device::SchedulingObtained& RealTimeExplorer::scheduling() const noexcept {
  return impl_->thread.scheduling();
}

device::ServoControl& RealTimeExplorer::control() noexcept {
  return impl_->control;
}

Exploration RealTimeExplorer::explore(device::ForceSource& force, const PlaneGeometry& plane,
                                      Participant& participant, const device::ServoOptions& options,
                                      record::Trace& trace) {
  Impl& impl = *impl_;
  impl.allocate(options);
  device::HapticDevice& device = participant.begin_exploring(plane);
  TraceBuilder builder(trace, options.rate_hz, max_samples(options));
  device::RingSink sink(*impl.ring);
  Exploration exploration;
  {
    const TraceWriter writer(*impl.ring, builder, participant);
    exploration.servo =
        impl.run(device, force, sink, options, participant, exploration.servo_start.emplace());
  }
  exploration.landed_at = builder.landed_at();
  exploration.duration =
      time_of_tick(exploration.servo.ticks + exploration.servo.overruns, options.rate_hz);
  exploration.held_in_contact = builder.held_in_contact();
  exploration.health = health_of(exploration.servo, sink.dropped(), builder.held());
  if (is_interrupted(exploration.servo))
    exploration.detail = detail_of(exploration.servo, impl.recorder->ticks());
  return exploration;
}

}  // namespace touchtrial::session
