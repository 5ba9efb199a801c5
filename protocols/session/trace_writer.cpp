#include "protocols/session/trace_writer.hpp"

#include <array>
#include <chrono>
#include <cstddef>
#include <span>

namespace touchtrial::session {
namespace {

// The servo must not be made to wake anybody, so that the writer looks by itself: often enough for
// a ring that holds seconds.
constexpr std::chrono::milliseconds kBetweenDrains{2};
constexpr std::size_t kAtOnce = 256;

}  // namespace

TraceWriter::TraceWriter(device::SampleRing& ring, TraceBuilder& builder, Participant& participant)
    : ring_(ring), builder_(builder), participant_(participant), thread_([this] { write(); }) {}

void TraceWriter::finish() noexcept {
  if (!thread_.joinable()) return;
  finishing_.store(true, std::memory_order_release);
  thread_.join();
}

void TraceWriter::write() noexcept {
  while (!finishing_.load(std::memory_order_acquire)) {
    if (!take_some()) std::this_thread::sleep_for(kBetweenDrains);
  }
  while (take_some()) {
  }
}

bool TraceWriter::take_some() noexcept {
  std::array<device::ServoSample, kAtOnce> samples;
  const std::size_t count = ring_.pop(samples);
  for (const device::ServoSample& sample : std::span(samples).first(count)) {
    builder_.add(sample);
    participant_.feel(sample);
  }
  return count > 0;
}

}  // namespace touchtrial::session
