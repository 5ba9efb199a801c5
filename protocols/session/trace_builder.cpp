#include "protocols/session/trace_builder.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::session {

std::chrono::nanoseconds time_of_tick(std::int64_t tick, double rate_hz) noexcept {
  constexpr double kNanosecondsPerS = 1e9;
  return std::chrono::nanoseconds(
      std::llround(static_cast<double>(tick) * kNanosecondsPerS / rate_hz));
}

TraceBuilder::TraceBuilder(store::Trace& trace, double rate_hz, std::size_t most_samples)
    : trace_(trace), room_(most_samples) {
  trace.rate_hz = rate_hz;
  trace.samples.clear();
  trace.samples.reserve(most_samples);
}

void TraceBuilder::add(const device::ServoSample& sample) noexcept {
  const auto tick = static_cast<std::size_t>(std::max<std::int64_t>(sample.tick, 0));
  if (tick >= room_ || tick < trace_.samples.size()) return;
  const store::TraceSample kept{sample.position_mm, sample.force_n};
  hold_until(tick, kept);
  if (!landing_tick_ && sample.position_mm.z <= kLandingHeightMm) landing_tick_ = sample.tick;
  trace_.samples.push_back(kept);
}

/// Before the first sample there is none to hold, so that it is held backwards.
void TraceBuilder::hold_until(std::size_t tick, const store::TraceSample& first) noexcept {
  const store::TraceSample last = trace_.samples.empty() ? first : trace_.samples.back();
  while (trace_.samples.size() < tick) {
    trace_.samples.push_back(last);
    ++held_;
    held_in_contact_ += last.force_n.z > 0.0 ? 1 : 0;
  }
}

std::optional<std::chrono::nanoseconds> TraceBuilder::landed_at() const noexcept {
  if (!landing_tick_) return std::nullopt;
  return time_of_tick(*landing_tick_, trace_.rate_hz);
}

}  // namespace touchtrial::session
