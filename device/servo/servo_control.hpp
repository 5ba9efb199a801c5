/// \file Requests of other threads, and of signal handlers, to a running servo.
#pragma once

#include <atomic>
#include <cstdint>

namespace touchtrial::device {

/// Requests to one run of the servo. All functions are thread-safe, async-signal-safe and
/// non-blocking. A request persists until `reset`.
class ServoControl {
 public:
  /// The person is done: the force fades as at the time limit; the run ends as hand_stopped.
  void finish() noexcept { set(kFinish); }
  /// The force falls to zero within 100 ms, without a step; the run ends as comfort_stop.
  void comfort_stop() noexcept { set(kComfortStop); }
  /// Zero force from the next tick on; the run ends with a fault.
  void emergency_stop() noexcept { set(kEmergencyStop); }
  /// The servo stopped ticking (Watchdog): like an emergency stop, but the run ends as stalled.
  void stall() noexcept { set(kStall); }
  /// Call before a new run: clears all requests. Only this cancels an emergency stop or a stall.
  void reset() noexcept { requests_.store(0, std::memory_order_release); }
  /// Call before a new run: clears all requests except an emergency stop and a stall, so that one
  /// arriving at this moment is not lost.
  void clear_requests() noexcept {
    requests_.fetch_and(kEmergencyStop | kStall, std::memory_order_acq_rel);
  }

  [[nodiscard]] bool finish_requested() const noexcept { return is_set(kFinish); }
  [[nodiscard]] bool comfort_stop_requested() const noexcept { return is_set(kComfortStop); }
  [[nodiscard]] bool emergency_stop_requested() const noexcept { return is_set(kEmergencyStop); }
  [[nodiscard]] bool stall_requested() const noexcept { return is_set(kStall); }

 private:
  static constexpr std::uint32_t kFinish = 1;
  static constexpr std::uint32_t kComfortStop = 2;
  static constexpr std::uint32_t kEmergencyStop = 4;
  static constexpr std::uint32_t kStall = 8;
  static_assert(std::atomic<std::uint32_t>::is_always_lock_free, "signal handlers set it");

  void set(std::uint32_t request) noexcept {
    requests_.fetch_or(request, std::memory_order_acq_rel);
  }
  [[nodiscard]] bool is_set(std::uint32_t request) const noexcept {
    return (requests_.load(std::memory_order_acquire) & request) != 0;
  }

  std::atomic<std::uint32_t> requests_{0};
};

}  // namespace touchtrial::device
