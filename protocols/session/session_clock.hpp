/// \file The clock by which a session's events are stamped.
#pragma once

#include <chrono>

namespace touchtrial::session {

/// Time since a session's opening, never decreasing. Not thread-safe.
class SessionClock {
 public:
  using Time = std::chrono::nanoseconds;
  virtual ~SessionClock() = default;

  [[nodiscard]] virtual Time now() = 0;
  /// Something has happened that takes this long. Virtual time goes on by it; real time has gone on
  /// by itself while it happened.
  virtual void pass(Time duration) = 0;
  /// When something happened, by the servo's monotonic clock. Virtual time knows of no other: now.
  [[nodiscard]] virtual Time of(std::chrono::steady_clock::time_point) { return now(); }
};

/// Starts at 0, or where it is told to, and goes on by what it is told.
class VirtualSessionClock final : public SessionClock {
 public:
  explicit VirtualSessionClock(Time start = {}) : now_(start) {}

  [[nodiscard]] Time now() override { return now_; }
  void pass(Time duration) override { now_ += duration; }

 private:
  Time now_{};
};

/// Real time since the clock was made, by the machine's monotonic clock.
class SteadySessionClock final : public SessionClock {
 public:
  /// \param start  what it shows when it is made: not 0 in a session that is taken up again
  explicit SteadySessionClock(Time start = {}) : zero_(std::chrono::steady_clock::now() - start) {}

  [[nodiscard]] Time now() override { return of(std::chrono::steady_clock::now()); }
  void pass(Time) override {}
  [[nodiscard]] Time of(std::chrono::steady_clock::time_point when) override {
    return when - zero_;
  }

 private:
  std::chrono::steady_clock::time_point zero_;
};

}  // namespace touchtrial::session
