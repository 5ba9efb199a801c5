#include "bench/jitter/trace_drain.hpp"

#include <chrono>
#include <vector>

namespace touchtrial::bench::jitter {
namespace {

constexpr std::size_t kSamplesOfTrace = 60'000;
constexpr std::size_t kBatch = 1024;
constexpr auto kPause = std::chrono::milliseconds(1);

}  // namespace

TraceDrain::TraceDrain(device::SampleRing& ring) : ring_(ring) {
  trace_.samples.reserve(kSamplesOfTrace);
  thread_ = std::thread(&TraceDrain::drain, this);
}

TraceDrain::~TraceDrain() {
  if (thread_.joinable()) static_cast<void>(finish());
}

TraceDrain::Totals TraceDrain::finish() {
  ending_ = true;
  thread_.join();
  return totals_;
}

void TraceDrain::drain() {
  std::vector<device::ServoSample> batch(kBatch);
  while (true) {
    // Asked before looking: what came before the end was told is found by this look.
    const bool last = ending_;
    const std::size_t got = ring_.pop(batch);
    keep(std::span(batch).first(got));
    if (got == 0 && last) break;
    if (got == 0) std::this_thread::sleep_for(kPause);
  }
  encode();
}

void TraceDrain::keep(std::span<const device::ServoSample> samples) {
  for (const device::ServoSample& sample : samples) {
    trace_.samples.push_back({sample.position_mm, sample.force_n});
    if (trace_.samples.size() == kSamplesOfTrace) encode();
  }
  totals_.samples += static_cast<std::int64_t>(samples.size());
}

void TraceDrain::encode() {
  if (!trace_.samples.empty()) {
    totals_.bytes += static_cast<std::int64_t>(store::encode_trace(trace_).size());
  }
  trace_.samples.clear();
}

}  // namespace touchtrial::bench::jitter
