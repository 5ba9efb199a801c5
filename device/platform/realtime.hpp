/// \file What the servo's thread asks of the operating system. One source file a platform.
#pragma once

#include <chrono>
#include <string>

namespace touchtrial::device {

enum class SchedulingPolicy {
  other,  ///< as every program: the thread shares the processor
  fifo,   ///< real time: it runs before all ordinary threads
};

/// What a servo thread would like to have.
struct SchedulingRequest {
  SchedulingPolicy policy = SchedulingPolicy::fifo;
  int priority = 80;        ///< of fifo, 1 to 99; clamped to what the system knows
  bool lock_memory = true;  ///< the whole process stays in memory: no page is fetched in the loop
};

/// What it got.
struct SchedulingObtained {
  SchedulingPolicy policy = SchedulingPolicy::other;
  int priority = 0;  ///< 0 unless fifo
  bool memory_locked = false;
  /// Why less than was asked for, and the remedy; empty if everything was had.
  std::string reason;
};

/// Asks for the calling thread, touches its stack so that the loop finds it in memory, and where
/// real time is not had asks for timers as exact as ordinary threads may have. Locking memory
/// concerns the whole process and stays. What is not permitted is left as it was and told.
[[nodiscard]] SchedulingObtained request_scheduling(const SchedulingRequest& request);

/// Time of the monotonic clock. No allocation, lock or exception.
[[nodiscard]] std::chrono::nanoseconds monotonic_now() noexcept;

/// Sleeps until this time of `monotonic_now`; at once if it is over. An interrupting signal does
/// not end it.
void sleep_until(std::chrono::nanoseconds time) noexcept;

}  // namespace touchtrial::device
