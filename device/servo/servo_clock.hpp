/// \file The clock that paces the servo. The loop asks it alone, so that tests own time.
#pragma once

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

/// Time that goes as fast as the processor: waiting is being there.
class VirtualClock final : public ServoClock {
 public:
  [[nodiscard]] Time now() noexcept override { return now_; }
  void wait_until(Time time) noexcept override {
    if (time > now_) now_ = time;
  }

 private:
  Time now_{};
};

}  // namespace touchtrial::device
