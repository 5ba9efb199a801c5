#include "app/monitor/monitor_run.hpp"

#include "device/servo/servo_clock.hpp"

#include <array>
#include <cstdint>

namespace touchtrial::app {
namespace {

/// Longer than anybody watches.
constexpr double kLongestRunS = 7.0 * 86'400.0;
constexpr double kFadeS = 0.1;
/// A window that is blocked for two seconds loses no sample.
constexpr double kRingS = 2.0;

/// A clock that records its worst lateness.
class WatchedClock final : public device::ServoClock {
 public:
  WatchedClock(device::ServoClock& clock, std::atomic<std::int64_t>& worst_ns) noexcept
      : clock_(clock), worst_ns_(worst_ns) {}

  [[nodiscard]] Time now() noexcept override { return clock_.now(); }
  void wait_until(Time time) noexcept override {
    clock_.wait_until(time);
    const std::int64_t late_ns = (clock_.now() - time).count();
    // The reader may take the worst value at any moment; this one then counts for the next period.
    std::int64_t worst_ns = worst_ns_.load(std::memory_order_relaxed);
    while (late_ns > worst_ns &&
           !worst_ns_.compare_exchange_weak(worst_ns, late_ns, std::memory_order_relaxed)) {
    }
  }

 private:
  device::ServoClock& clock_;
  std::atomic<std::int64_t>& worst_ns_;
};

}  // namespace

MonitorRun::MonitorRun(device::HapticDevice& device, double rate_hz,
                       const device::SafetyLimits& limits, device::WatchdogTime& time)
    : device_(device),
      options_{.limit_ticks = static_cast<std::int64_t>(kLongestRunS * rate_hz),
               .fade_ticks = static_cast<std::int64_t>(kFadeS * rate_hz),
               .limits = limits,
               .rate_hz = rate_hz},
      wall_(rate_hz),
      ring_(static_cast<std::size_t>(kRingS * rate_hz)),
      sink_(ring_),
      watchdog_(device, control_, heartbeat_, device::Watchdog::silence_for(device.info()), time),
      signals_(device, control_) {}

MonitorRun::~MonitorRun() {
  control_.finish();
}

void MonitorRun::start() {
  if (running() || device::StopOnSignals::asked()) return;
  control_.reset();
  device_.rearm();
  waited_for_ = false;
  has_run_ = true;
  watchdog_.arm();
  thread_.start([this] { run(); });
}

void MonitorRun::run() noexcept {
  device::PacedClock paced(device::PacedClock::usual_spin(thread_.scheduling().policy));
  WatchedClock clock(paced, worst_late_ns_);
  report_ = device::run_servo(device_, wall_, sink_, options_, clock,
                              {.control = &control_, .state = &states_, .heartbeat = &heartbeat_});
}

bool MonitorRun::running() {
  if (thread_.running()) return true;
  if (!waited_for_) {
    watchdog_.disarm();
    thread_.wait();
  }
  waited_for_ = true;
  return false;
}

std::optional<device::ServoReport> MonitorRun::ended() {
  if (running() || !has_run_) return std::nullopt;
  return report_;
}

void MonitorRun::collect(MonitorHistory& history) {
  std::array<device::ServoSample, 256> samples;
  while (const std::size_t count = ring_.pop(samples)) {
    for (std::size_t i = 0; i < count; ++i) history.add(samples[i]);
  }
  const std::int64_t late_ns = worst_late_ns_.exchange(-1, std::memory_order_relaxed);
  if (late_ns >= 0) history.add_lateness(static_cast<double>(late_ns) * 1e-3);
}

}  // namespace touchtrial::app
