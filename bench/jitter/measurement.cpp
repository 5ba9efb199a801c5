#include "bench/jitter/measurement.hpp"

#include "device/servo/flight_recorder.hpp"
#include "device/servo/sample_ring.hpp"
#include "device/servo/servo_clock.hpp"
#include "device/servo/servo_thread.hpp"
#include "protocols/session/exploration.hpp"
#include "protocols/store/trace.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <thread>
#include <vector>

namespace touchtrial::bench::jitter {
namespace {

/// 16 s at 4 kHz, 3.7 MB.
constexpr std::size_t kRingSamples = 65'536;
constexpr double kRecordedS = 5.0;
constexpr double kTau = 2.0 * std::numbers::pi;

/// A device whose stylus descends to the plane and then strokes it at up to 80 mm/s, 1 mm deep,
/// whatever the force. Its state is a function of the number of ticks.
class LedStylus final : public device::HapticDevice {
 public:
  LedStylus(const PlaneGeometry& plane, double rate_hz) noexcept
      : middle_mm_{0.5 * plane.width_mm(), 0.5 * plane.height_mm()},
        reach_mm_{reach_of(plane.width_mm(), kTurnsPerS.x),
                  reach_of(plane.height_mm(), kTurnsPerS.y)},
        tick_s_(1.0 / rate_hz) {}

  [[nodiscard]] device::DeviceInfo info() const override { return {"led stylus", "", 3.3, true}; }

  [[nodiscard]] device::DeviceStatus read(device::DeviceSample& sample) noexcept override {
    const double time_s = static_cast<double>(ticks_) * tick_s_;
    const Vec2 turn = kTau * kTurnsPerS;
    const double z_mm = std::max(-kDepthMm, kStartHeightMm - kDescentMmPerS * time_s);
    sample.position_mm = {middle_mm_.x + reach_mm_.x * std::sin(turn.x * time_s),
                          middle_mm_.y + reach_mm_.y * std::sin(turn.y * time_s), z_mm};
    sample.velocity_mm_s = {reach_mm_.x * turn.x * std::cos(turn.x * time_s),
                            reach_mm_.y * turn.y * std::cos(turn.y * time_s),
                            z_mm > -kDepthMm ? -kDescentMmPerS : 0.0};
    sample.sequence = static_cast<std::uint64_t>(++ticks_);
    return device::DeviceStatus::ok;
  }

  [[nodiscard]] device::DeviceStatus write(Vec3) noexcept override {
    return device::DeviceStatus::ok;
  }
  void halt() noexcept override {}
  void rearm() noexcept override {}

 private:
  static constexpr double kStartHeightMm = 2.0;
  static constexpr double kDepthMm = 1.0;
  static constexpr double kDescentMmPerS = 20.0;
  /// Two frequencies without a common period, so that strokes never repeat.
  static constexpr Vec2 kTurnsPerS = {0.31, 0.23};
  static constexpr double kFastestMmPerS = 80.0;

  /// Most of the plane, or less where that would be too fast.
  static double reach_of(double side_mm, double turns_per_s) noexcept {
    return std::min(0.4 * side_mm, kFastestMmPerS / std::sqrt(2.0) / (kTau * turns_per_s));
  }

  Vec2 middle_mm_;
  Vec2 reach_mm_;
  double tick_s_;
  std::int64_t ticks_ = 0;
};

/// Threads of ordinary priority that keep the processor busy while this object lives.
class LoadThreads {
 public:
  explicit LoadThreads(int count) {
    for (int i = 0; i < count; ++i) {
      threads_.emplace_back([this] {
        while (!ending_.load(std::memory_order_relaxed)) {
        }
      });
    }
  }
  ~LoadThreads() {
    ending_ = true;
    for (std::thread& thread : threads_) thread.join();
  }
  LoadThreads(const LoadThreads&) = delete;
  LoadThreads& operator=(const LoadThreads&) = delete;

 private:
  std::atomic<bool> ending_{false};
  std::vector<std::thread> threads_;
};

/// A thread that takes samples from a ring and encodes them as a session does, in traces of one
/// minute at 1 kHz. The encoded traces are discarded.
class TraceDrain {
 public:
  /// \param ring  must outlive this
  explicit TraceDrain(device::SampleRing& ring) : ring_(ring) {
    trace_.samples.reserve(kSamplesOfTrace);
    thread_ = std::thread(&TraceDrain::drain, this);
  }
  ~TraceDrain() {
    if (thread_.joinable()) static_cast<void>(finish());
  }
  TraceDrain(const TraceDrain&) = delete;
  TraceDrain& operator=(const TraceDrain&) = delete;

  /// Encodes what is left in the ring and ends the thread. Nothing may be pushed after the call.
  /// \return samples encoded in all
  std::int64_t finish() {
    ending_ = true;
    thread_.join();
    return samples_;
  }

 private:
  static constexpr std::size_t kSamplesOfTrace = 60'000;
  static constexpr std::size_t kBatch = 1024;

  void drain() {
    std::vector<device::ServoSample> batch(kBatch);
    while (true) {
      // Read before the ring: samples that were pushed before the end are found by this pop.
      const bool last = ending_;
      const std::size_t got = ring_.pop(batch);
      keep(std::span(batch).first(got));
      if (got == 0 && last) break;
      if (got == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    encode();
  }

  void keep(std::span<const device::ServoSample> samples) {
    for (const device::ServoSample& sample : samples) {
      trace_.samples.push_back({sample.position_mm, sample.force_n});
      if (trace_.samples.size() == kSamplesOfTrace) encode();
    }
    samples_ += static_cast<std::int64_t>(samples.size());
  }

  void encode() {
    if (!trace_.samples.empty()) static_cast<void>(store::encode_trace(trace_));
    trace_.samples.clear();
  }

  device::SampleRing& ring_;
  store::Trace trace_;
  std::int64_t samples_ = 0;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

/// A real-time clock that never waits for a tick, and measures the time between two.
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
  /// Rarely: each look takes the ring's index out of the reader's cache.
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
  Rig(const app::TestTexture& texture, const Conditions& conditions)
      : thread_({.policy = conditions.policy}),
        load_(conditions.load),
        stylus_(texture.plane(), conditions.rate_hz),
        model_(texture.texture()),
        recorder_(kRecordedS, conditions.rate_hz) {
    done_.conditions = conditions;
    done_.scheduling = thread_.scheduling();
  }

  [[nodiscard]] device::SampleRing& ring() noexcept { return ring_; }
  [[nodiscard]] device::SchedulingPolicy policy() const noexcept { return done_.scheduling.policy; }
  [[nodiscard]] device::DurationHistogram& histogram() noexcept { return done_.histogram; }

  /// \param lateness  receives the lateness of each tick; may be null
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
  engine::RenderingModel model_;
  session::ModelForce force_{model_};
  device::SampleRing ring_{kRingSamples};
  device::RingSink sink_{ring_};
  TraceDrain drain_{ring_};
  device::ServoControl control_;
  device::LatestValue<device::ServoState> state_;
  std::atomic<std::int64_t> heartbeat_{0};
  device::FlightRecorder recorder_;
};

}  // namespace

Measurement measure_lateness(const app::TestTexture& texture, const Conditions& conditions,
                             double seconds) {
  Rig rig(texture, conditions);
  device::PacedClock clock(device::PacedClock::usual_spin(rig.policy()));
  const auto ticks = static_cast<std::int64_t>(seconds * conditions.rate_hz);
  return rig.run(clock, ticks, &rig.histogram());
}

Measurement measure_service(const app::TestTexture& texture, const Conditions& conditions,
                            std::int64_t ticks) {
  Rig rig(texture, conditions);
  ServiceClock clock(rig.ring(), rig.histogram());
  return rig.run(clock, ticks, nullptr);
}

}  // namespace touchtrial::bench::jitter
