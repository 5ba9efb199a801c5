/// \file The clock that stamps a session's events.
#pragma once

#include <chrono>

namespace touchtrial::session {

/// Time since a session's opening; never decreases. Not thread-safe.
class SessionClock {
 public:
  using Time = std::chrono::nanoseconds;
  virtual ~SessionClock() = default;

  [[nodiscard]] virtual Time now() = 0;
  /// Advances virtual time; has no effect in real time.
  virtual void advance(Time duration) = 0;
  /// Converts a time of the servo's monotonic clock. In virtual time, returns `now`.
  [[nodiscard]] virtual Time time_of(std::chrono::steady_clock::time_point) { return now(); }
};

/// Advances only by `advance`.
class VirtualSessionClock final : public SessionClock {
 public:
  explicit VirtualSessionClock(Time start = {}) : now_(start) {}

  [[nodiscard]] Time now() override { return now_; }
  void advance(Time duration) override { now_ += duration; }

 private:
  Time now_{};
};

/// Real time since construction, by the machine's monotonic clock.
class SteadySessionClock final : public SessionClock {
 public:
  /// \param start  first value; not 0 in a resumed session
  explicit SteadySessionClock(Time start = {}) : zero_(std::chrono::steady_clock::now() - start) {}

  [[nodiscard]] Time now() override { return time_of(std::chrono::steady_clock::now()); }
  void advance(Time) override {}
  [[nodiscard]] Time time_of(std::chrono::steady_clock::time_point time) override {
    return time - zero_;
  }

 private:
  std::chrono::steady_clock::time_point zero_;
};

}  // namespace touchtrial::session
