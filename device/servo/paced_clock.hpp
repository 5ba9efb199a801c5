/// \file The clock of a real run: real time, with each tick awaited as exactly as can be.
#pragma once

#include "device/platform/realtime.hpp"
#include "device/servo/servo_clock.hpp"

namespace touchtrial::device {

/// Sleeps until shortly before the deadline and spins for the rest, because a thread that sleeps
/// is woken late.
class PacedClock final : public ServoClock {
 public:
  /// What is spun for the policy that a thread has. A thread in real time can afford to outlast
  /// most wake-ups, an ordinary one that spins for long loses its turn sooner.
  [[nodiscard]] static Time usual_spin(SchedulingPolicy policy) noexcept {
    return std::chrono::microseconds(policy == SchedulingPolicy::fifo ? 150 : 50);
  }

  /// \param spin  >= 0, how long before the deadline the thread wakes
  explicit PacedClock(Time spin) noexcept : spin_(spin) {}

  [[nodiscard]] Time now() noexcept override { return monotonic_now(); }
  void wait_until(Time time) noexcept override {
    if (monotonic_now() < time - spin_) sleep_until(time - spin_);
    while (monotonic_now() < time) {
    }
  }

 private:
  Time spin_;
};

}  // namespace touchtrial::device
