#include "bench/jitter/measurement.hpp"

#include "bench/jitter/load_threads.hpp"
#include "device/servo/flight_recorder.hpp"
#include "device/servo/paced_clock.hpp"
#include "device/servo/sample_ring.hpp"
#include "device/servo/servo_thread.hpp"
#include "protocols/session/model_force.hpp"

#include <atomic>
#include <optional>

namespace touchtrial::bench::jitter {
namespace {

/// 16 s at 4 kHz, 3.7 MB.
constexpr std::size_t kRingSamples = 65'536;
constexpr double kRecordedS = 5.0;

/// Real time that never waits for a tick, and takes the time between two.
class ServiceClock final : public device::ServoClock {
 public:
  ServiceClock(const device::SampleRing& ring, device::DurationHistogram& service) noexcept
      : ring_(ring), service_(service) {}

  [[nodiscard]] Time now() noexcept override { return device::monotonic_now(); }

  void wait_until(Time) noexcept override {
    const Time end = device::monotonic_now();
    if (begin_) service_.add(end - *begin_);
    begin_ = end;
    if (++ticks_ % kLookEvery == 0) let_the_writer_catch_up();
  }

 private:
  /// Seldom: looking takes the ring's index from the reader's cache.
  static constexpr int kLookEvery = 4096;
  static_assert(kLookEvery < kRingSamples / 2, "the ring must not fill between two looks");

  void let_the_writer_catch_up() noexcept {
    if (ring_.waiting() < ring_.capacity() / 2) return;
    while (ring_.waiting() > ring_.capacity() / 4) {
      device::sleep_until(device::monotonic_now() + std::chrono::milliseconds(1));
    }
    begin_ = device::monotonic_now();
  }

  const device::SampleRing& ring_;
  device::DurationHistogram& service_;
  std::optional<Time> begin_;
  int ticks_ = 0;
};

/// Everything that a session has around its servo.
class Rig {
 public:
  Rig(const BenchScene& scene, const Conditions& conditions)
      : thread_({.policy = conditions.policy}),
        load_(conditions.load),
        stylus_(scene.plane(), conditions.rate_hz),
        force_(scene.model()),
        recorder_(kRecordedS, conditions.rate_hz) {
    done_.conditions = conditions;
    done_.scheduling = thread_.scheduling();
  }

  [[nodiscard]] device::SampleRing& ring() noexcept { return ring_; }
  [[nodiscard]] device::SchedulingPolicy policy() const noexcept { return done_.scheduling.policy; }
  [[nodiscard]] device::DurationHistogram& histogram() noexcept { return done_.histogram; }

  /// \param lateness  where the loop puts it; null: nowhere
  Measurement run(device::ServoClock& clock, std::int64_t ticks,
                  device::DurationHistogram* lateness) {
    const device::ServoOptions options{
        .limit_ticks = ticks, .fade_ticks = 0, .rate_hz = done_.conditions.rate_hz};
    const device::ServoHooks hooks{&control_, &state_, &heartbeat_, &recorder_, lateness};
    thread_.run(
        [&] { done_.report = device::run_servo(stylus_, force_, sink_, options, clock, hooks); });
    done_.written = drain_.finish();
    done_.dropped = sink_.dropped();
    return done_;
  }

 private:
  Measurement done_;
  device::ServoThread thread_;
  LoadThreads load_;
  LedStylus stylus_;
  session::ModelForce force_;
  device::SampleRing ring_{kRingSamples};
  device::RingSink sink_{ring_};
  TraceDrain drain_{ring_};
  device::ServoControl control_;
  device::LatestValue<device::ServoState> state_;
  std::atomic<std::int64_t> heartbeat_{0};
  device::FlightRecorder recorder_;
};

}  // namespace

Measurement measure_lateness(const BenchScene& scene, const Conditions& conditions,
                             double seconds) {
  Rig rig(scene, conditions);
  device::PacedClock clock(device::PacedClock::usual_spin(rig.policy()));
  const auto ticks = static_cast<std::int64_t>(seconds * conditions.rate_hz);
  return rig.run(clock, ticks, &rig.histogram());
}

Measurement measure_service(const BenchScene& scene, const Conditions& conditions,
                            std::int64_t ticks) {
  Rig rig(scene, conditions);
  ServiceClock clock(rig.ring(), rig.histogram());
  return rig.run(clock, ticks, nullptr);
}

}  // namespace touchtrial::bench::jitter
