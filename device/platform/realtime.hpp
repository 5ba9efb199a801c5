/// \file Real-time scheduling, the monotonic clock, and a marker for code that must not block. One
///   source file per platform.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace touchtrial::device {

enum class SchedulingPolicy {
  other,  ///< default scheduling
  fifo,   ///< real time: the thread has priority over all ordinary threads
};

/// \return "other" or "fifo", as files and reports call the policy
[[nodiscard]] constexpr std::string_view name_of(SchedulingPolicy policy) noexcept {
  return policy == SchedulingPolicy::fifo ? "fifo" : "other";
}

/// The scheduling that a servo thread requests.
struct SchedulingRequest {
  SchedulingPolicy policy = SchedulingPolicy::fifo;
  int priority = 80;        ///< of fifo, 1 to 99; clamped to the system's range
  bool lock_memory = true;  ///< of the whole process, so that the loop has no page faults
};

/// The scheduling that it obtained.
struct SchedulingObtained {
  SchedulingPolicy policy = SchedulingPolicy::other;
  int priority = 0;  ///< 0 unless fifo
  bool memory_locked = false;
  /// Why the thread obtained less than it requested, and the remedy; empty if it obtained
  /// everything.
  std::string reason;
};

/// Requests scheduling for the calling thread and prefaults its stack. A thread without real-time
/// scheduling gets the most precise timers of ordinary threads. Memory is locked for the whole
/// process and stays locked. The result reports what the system refused.
[[nodiscard]] SchedulingObtained request_scheduling(const SchedulingRequest& request);

/// \return the time of the monotonic clock. No allocation, lock or exception.
[[nodiscard]] std::chrono::nanoseconds monotonic_now() noexcept;

/// Sleeps until this time of `monotonic_now`, regardless of signals; returns at once if it has
/// passed.
void sleep_until(std::chrono::nanoseconds time) noexcept;

/// Marks the calling thread as inside the servo loop, where code must not allocate, lock or do I/O.
/// The servo enters once per run, so the cost is negligible; tests detect allocations and locks
/// inside.
class RealtimeRegion {
 public:
  RealtimeRegion() noexcept { ++depth_; }
  ~RealtimeRegion() { --depth_; }
  RealtimeRegion(const RealtimeRegion&) = delete;
  RealtimeRegion& operator=(const RealtimeRegion&) = delete;

  /// \return whether the calling thread is inside a region. Allocates nothing.
  [[nodiscard]] static bool entered() noexcept { return depth_ > 0; }

 private:
  // Constant-initialised, so that the first use on a thread runs no constructor.
  static constinit inline thread_local int depth_ = 0;
};

}  // namespace touchtrial::device
