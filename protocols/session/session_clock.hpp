/// \file The clock by which a session's events are stamped.
#pragma once

#include <chrono>

namespace touchtrial {

/// Time since a session's opening, never decreasing. Not thread-safe.
class SessionClock {
 public:
  using Time = std::chrono::nanoseconds;
  virtual ~SessionClock() = default;

  [[nodiscard]] virtual Time now() = 0;
  /// Something has happened that takes this long. Virtual time goes on by it; real time has gone on
  /// by itself while it happened.
  virtual void pass(Time duration) = 0;
};

/// Starts at 0 and goes on by what it is told.
class VirtualSessionClock final : public SessionClock {
 public:
  [[nodiscard]] Time now() override { return now_; }
  void pass(Time duration) override { now_ += duration; }

 private:
  Time now_{};
};

/// Real time since the clock was made, by the machine's monotonic clock.
class SteadySessionClock final : public SessionClock {
 public:
  [[nodiscard]] Time now() override { return std::chrono::steady_clock::now() - start_; }
  void pass(Time) override {}

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace touchtrial
