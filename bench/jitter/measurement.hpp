/// \file What servo_jitter measures: how late ticks begin, and how long the work of one takes.
#pragma once

#include "app/test_texture.hpp"
#include "device/platform/realtime.hpp"
#include "device/servo/duration_histogram.hpp"
#include "device/servo/servo.hpp"

#include <cstdint>

namespace touchtrial::bench::jitter {

/// The conditions of one measurement.
struct Conditions {
  double rate_hz = device::kServoRateHz;
  device::SchedulingPolicy policy = device::SchedulingPolicy::fifo;  ///< requested
  int load = 0;  ///< busy threads that run at the same time, >= 0
};

/// One measurement. The servo runs with all its hooks, on a stylus that strokes a texture without
/// hardware; its samples go through a ring to a thread that encodes traces.
struct Measurement {
  Conditions conditions;
  device::SchedulingObtained scheduling;
  device::ServoReport report;
  device::DurationHistogram histogram;  ///< of lateness, or of service times
  std::int64_t dropped = 0;             ///< samples for which the ring had no room
  std::int64_t written = 0;             ///< samples that the trace thread encoded
};

/// Measures the lateness of a paced servo.
/// \param texture  what the stylus strokes
/// \param seconds  > 0
[[nodiscard]] Measurement measure_lateness(const app::TestTexture& texture,
                                           const Conditions& conditions, double seconds);

/// Measures service time: from the beginning of one tick's work to the beginning of the next, with
/// no waiting in between. Because unpaced ticks outrun any writer, the servo pauses between two
/// ticks while the ring is more than half full; these pauses are not measured.
/// \param texture  what the stylus strokes
/// \param ticks  > 0
[[nodiscard]] Measurement measure_service(const app::TestTexture& texture,
                                          const Conditions& conditions, std::int64_t ticks);

}  // namespace touchtrial::bench::jitter
