/// \file What servo_jitter measures: how late ticks begin, and how long the work of one takes.
#pragma once

#include "bench/jitter/bench_scene.hpp"
#include "bench/jitter/trace_drain.hpp"
#include "device/platform/realtime.hpp"
#include "device/servo/duration_histogram.hpp"
#include "device/servo/servo.hpp"

#include <cstdint>

namespace touchtrial::bench::jitter {

/// The conditions of one measurement.
struct Conditions {
  double rate_hz = device::kServoRateHz;
  device::SchedulingPolicy policy = device::SchedulingPolicy::fifo;  ///< asked for
  int load = 0;  ///< threads that spin beside it, >= 0
};

/// One measurement. In both kinds the servo has its hooks on, and samples go through a ring to a
/// thread that encodes traces.
struct Measurement {
  Conditions conditions;
  device::SchedulingObtained scheduling;
  device::ServoReport report;
  device::DurationHistogram histogram;  ///< of lateness, or of service times
  std::int64_t dropped = 0;             ///< samples for which the ring had no room
  TraceDrain::Totals written;
};

/// Lateness of a paced servo.
/// \param seconds  > 0
[[nodiscard]] Measurement measure_lateness(const BenchScene& scene, const Conditions& conditions,
                                           double seconds);

/// Service time: from the beginning of a tick's work to the beginning of the next one's, with
/// nothing to wait for. Ticks would outrun any writer, so between two of them, and outside what is
/// measured, the servo stands still while the ring is more than half full.
/// \param ticks  > 0
[[nodiscard]] Measurement measure_service(const BenchScene& scene, const Conditions& conditions,
                                          std::int64_t ticks);

}  // namespace touchtrial::bench::jitter
