#include "app/monitor/monitor_run.hpp"

#include "device/servo/servo_clock.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace touchtrial::app {
namespace {

/// The number of bins for one rate.
constexpr std::size_t kRateBins = 5;

}  // namespace

void Extent::add(double value) noexcept {
  least = std::min(least, value);
  greatest = std::max(greatest, value);
}

MonitorHistory::MonitorHistory(double rate_hz) : rate_hz_(rate_hz), bins_(kBins) {}

void MonitorHistory::add(const device::ServoSample& sample) {
  if (sample.tick <= last_tick_) {
    bins_.assign(kBins, Bin{});
    newest_ = -1;
    told_until_ = -1;
  }
  last_tick_ = sample.tick;
  const auto number =
      static_cast<std::int64_t>(static_cast<double>(sample.tick) * kBinsPerS / rate_hz_);
  const std::int64_t unseen = std::min<std::int64_t>(number - newest_, kBins);
  for (std::int64_t back = 0; back < unseen; ++back) bin_at(number - back) = Bin{};
  newest_ = number;
  Bin& bin = bin_at(number);
  ++bin.samples;
  const Vec3 p = sample.position_mm;
  const Vec3 f = sample.force_n;
  const std::array<double, 6> values = {p.x, p.y, p.z, f.x, f.y, f.z};
  for (std::size_t i = 0; i < values.size(); ++i) bin.channels[i].add(values[i]);
}

void MonitorHistory::add_lateness(double late_us) {
  const std::int64_t oldest = newest_ + 1 - static_cast<std::int64_t>(kBins);
  for (std::int64_t bin = std::max({told_until_ + 1, oldest, std::int64_t{0}}); bin < newest_;
       ++bin) {
    bin_at(bin).lateness_us.add(late_us);
  }
  if (newest_ >= 0) bin_at(newest_).lateness_us.add(late_us);
  told_until_ = newest_;
}

std::vector<Extent> MonitorHistory::values(Channel channel) const {
  std::vector<Extent> values(kBins);
  for (std::size_t i = 0; i < kBins; ++i) {
    values[i] = from_oldest(i).channels[static_cast<std::size_t>(channel)];
  }
  return values;
}

std::vector<Extent> MonitorHistory::rates_hz() const {
  std::vector<Extent> rates(kBins);
  // The newest bin is still being filled.
  for (std::size_t i = kRateBins - 1; i + 1 < kBins; ++i) {
    int samples = 0;
    for (std::size_t back = 0; back < kRateBins; ++back) samples += from_oldest(i - back).samples;
    const bool began_before = from_oldest(i + 1 - kRateBins).samples > 0;
    if (began_before) rates[i].add(samples / (kRateBins * kBinS));
  }
  return rates;
}

std::vector<Extent> MonitorHistory::lateness_us() const {
  std::vector<Extent> lateness(kBins);
  for (std::size_t i = 0; i < kBins; ++i) lateness[i] = from_oldest(i).lateness_us;
  return lateness;
}

MonitorHistory::Bin& MonitorHistory::bin_at(std::int64_t number) noexcept {
  constexpr auto kCount = static_cast<std::int64_t>(kBins);
  return bins_[static_cast<std::size_t>((number % kCount + kCount) % kCount)];
}

const MonitorHistory::Bin& MonitorHistory::from_oldest(std::size_t index) const noexcept {
  const auto place = static_cast<std::size_t>(newest_ + 1) + index;
  return bins_[place % kBins];
}

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
      wall_(rate_hz, device.info().max_stiffness_n_per_mm),
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
