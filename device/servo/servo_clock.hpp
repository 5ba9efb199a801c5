/// \file The clock that paces the servo. The loop uses no other clock, so that tests control time.
#pragma once

#include "device/platform/realtime.hpp"

#include <chrono>

namespace touchtrial::device {

/// Monotonic time since some fixed moment. Belongs to the servo thread.
class ServoClock {
 public:
  using Time = std::chrono::nanoseconds;
  virtual ~ServoClock() = default;

  [[nodiscard]] virtual Time now() noexcept = 0;
  /// Returns at or after this time; at once if it has passed.
  virtual void wait_until(Time time) noexcept = 0;
};

/// Virtual time: waiting for a time sets it.
class VirtualClock final : public ServoClock {
 public:
  [[nodiscard]] Time now() noexcept override { return now_; }
  void wait_until(Time time) noexcept override {
    if (time > now_) now_ = time;
  }

 private:
  Time now_{};
};

/// Real time. A sleeping thread is woken late, so this clock sleeps until shortly before the
/// deadline and spins for the rest.
class PacedClock final : public ServoClock {
 public:
  /// \return the spin that suits a thread's policy. A real-time thread can spin long enough to
  ///   absorb most late wake-ups; an ordinary thread that spins for long is preempted
  [[nodiscard]] static Time default_spin(SchedulingPolicy policy) noexcept {
    return std::chrono::microseconds(policy == SchedulingPolicy::fifo ? 150 : 50);
  }

  /// \param spin  how long before the deadline the thread wakes, >= 0
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
