/// \file Records the last seconds of a run, tick by tick, to explain a fault.
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

/// The data of one tick. Forces on a texture identify the texture, so in a blind session these data
/// are as secret as the trace.
struct FlightTick {
  std::int64_t tick = 0;            ///< as ServoSample::tick
  std::chrono::nanoseconds time{};  ///< since the first tick, when this one began
  DeviceSample sample;              ///< as the servo read it
  Vec3 requested_n;                 ///< from force source and support, after the fade
  Vec3 sent_n;                      ///< after the safety chain
  SafetyVerdict verdict = SafetyVerdict::passed;
  SafetyFault fault = SafetyFault::none;
  DeviceFault device_fault = DeviceFault::none;
  double lateness_us = 0.0;
};

/// A ring of the newest ticks. `record` belongs to the servo thread and allocates nothing; call the
/// other functions while no run uses the recorder.
class FlightRecorder {
 public:
  /// \param seconds  > 0
  /// \param rate_hz  > 0
  /// \throws std::invalid_argument if one is not > 0, or if their product exceeds 10^7 ticks
  FlightRecorder(double seconds, double rate_hz);

  void record(const FlightTick& tick) noexcept;

  /// \return the recorded ticks, oldest first
  [[nodiscard]] std::vector<FlightTick> ticks() const;
  /// Discards all ticks, before the next trial.
  void clear() noexcept { recorded_ = 0; }

 private:
  std::vector<FlightTick> ring_;
  std::size_t recorded_ = 0;
};

/// \return a header and one row per tick, by RFC 4180, with a decimal point in every locale;
/// numbers have the fewest digits that round-trip exactly
[[nodiscard]] std::string flight_csv(std::span<const FlightTick> ticks);

}  // namespace touchtrial::device
