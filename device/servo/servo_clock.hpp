/// \file The clock that paces the servo. The loop asks nothing else for the time, so that tests own
/// it.
#pragma once

#include "device/platform/realtime.hpp"

#include <chrono>

namespace touchtrial::device {

/// Monotonic time since any fixed moment. Belongs to the servo thread.
class ServoClock {
 public:
  using Time = std::chrono::nanoseconds;
  virtual ~ServoClock() = default;

  [[nodiscard]] virtual Time now() noexcept = 0;
  /// Returns at or after this time; at once if it is over.
  virtual void wait_until(Time time) noexcept = 0;
};

/// Time that goes as fast as the processor: to wait for a time is to be there.
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
  /// \return the spin that suits a thread's policy: a real-time thread can afford to outlast most
  ///   late wake-ups, an ordinary one that spins for long loses its turn sooner
  [[nodiscard]] static Time usual_spin(SchedulingPolicy policy) noexcept {
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
