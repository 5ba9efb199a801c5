/// \file The last seconds of a run, tick by tick, for whoever has to explain a fault.
#pragma once

#include "device/haptic_device.hpp"
#include "device/safety/safety_chain.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::device {

/// Everything about one tick. Forces on a texture tell which one it is: of a blind session this is
/// as secret as its trace.
struct FlightTick {
  std::int64_t tick = 0;            ///< as ServoSample::tick
  std::chrono::nanoseconds time{};  ///< since the first tick, when this one began
  DeviceSample sample;              ///< as the servo read it
  Vec3 requested_n;                 ///< what the force source and the fade asked for
  Vec3 sent_n;                      ///< what the safety chain let pass
  SafetyVerdict verdict = SafetyVerdict::passed;
  SafetyFault fault = SafetyFault::none;
  DeviceFault device_fault = DeviceFault::none;
  double lateness_us = 0.0;
};

/// A ring of the newest ticks. `record` belongs to the servo thread and allocates nothing; the rest
/// is for when no run uses the recorder.
class FlightRecorder {
 public:
  /// \param seconds  > 0  \param rate_hz  > 0
  /// \throws std::invalid_argument if they are not, or if their product is beyond 10^7 ticks
  FlightRecorder(double seconds, double rate_hz);

  void record(const FlightTick& tick) noexcept;

  /// The ticks it holds, oldest first.
  [[nodiscard]] std::vector<FlightTick> ticks() const;
  /// Before the next trial.
  void clear() noexcept { recorded_ = 0; }

 private:
  std::vector<FlightTick> ring_;
  std::size_t recorded_ = 0;
};

/// One row a tick under a row of names, by RFC 4180, with a decimal point whatever the locale;
/// numbers as short as they are exact.
[[nodiscard]] std::string flight_csv(std::span<const FlightTick> ticks);

}  // namespace touchtrial::device
