/// \file The servo loop: read, force, safety, write, record, a thousand times a second.
#pragma once

#include "device/haptic_device.hpp"

#include <chrono>
#include <cstdint>

namespace touchtrial {

/// One tick of the servo.
constexpr std::chrono::nanoseconds kServoTick{1'000'000};
constexpr double kServoRateHz = 1000.0;
constexpr double kServoTickS = 1.0 / kServoRateHz;

/// What the servo asks for a force. Called on the servo thread: no heap, lock, log or I/O.
class ForceSource {
 public:
  virtual ~ForceSource() = default;
  /// The force on the hand in this state, N, in the plane frame.
  [[nodiscard]] virtual Vec3 force_n(const DeviceSample& sample) noexcept = 0;
};

/// One tick as it was: where the stylus was, and the force that was sent.
struct ServoSample {
  Vec3 position_mm;
  Vec3 force_n;
};

/// Who keeps the samples. Called on the servo thread: room for all of them is reserved before.
class SampleSink {
 public:
  virtual ~SampleSink() = default;
  virtual void record(const ServoSample& sample) noexcept = 0;
};

struct ServoOptions {
  /// Ticks until time is up, >= 0.
  std::int64_t limit_ticks = 60'000;
  /// Ticks in which the force fades to nothing when time is up, >= 0; recorded like the others.
  std::int64_t fade_ticks = 100;
  /// Limit of the force's norm, > 0; the device's own maximum holds as well.
  double max_force_n = 3.3;
};

/// Why the loop ended.
enum class ServoEnd {
  hand_stopped,  ///< the device said that the hand is done
  time_limit,    ///< time was up, and the force has faded
  fault,         ///< the device was lost, or a force was not finite
};

struct ServoReport {
  ServoEnd end = ServoEnd::fault;
  std::int64_t ticks = 0;          ///< recorded samples
  std::int64_t limited_ticks = 0;  ///< shortened by the safety chain
  double force_limit_n = 0.0;      ///< that held: the smaller of the options' and the device's
};

/// Runs the loop in virtual time, as fast as the processor goes: tick i is at i * kServoTick, and
/// there is nothing to be late for. Every force goes through the safety chain; the last one written
/// is zero. No allocation, lock or exception inside the loop.
[[nodiscard]] ServoReport run_servo_in_virtual_time(HapticDevice& device, ForceSource& force,
                                                    SampleSink& sink, const ServoOptions& options);

}  // namespace touchtrial
