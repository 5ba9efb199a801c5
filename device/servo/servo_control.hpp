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
  void finish() noexcept { ask(kFinish); }
  /// The force goes to zero within 100 ms, without a step; the run ends as comfort_stop.
  void comfort_stop() noexcept { ask(kComfortStop); }
  /// Zero force from the next tick on; the run ends with a fault.
  void emergency_stop() noexcept { ask(kEmergencyStop); }
  /// The servo stopped ticking (Watchdog): like an emergency stop, but the run ends as stalled.
  void stall() noexcept { ask(kStall); }
  /// Call before a new run: clears all requests. Only this cancels an emergency stop or a stall.
  void reset() noexcept { requests_.store(0, std::memory_order_release); }
  /// Call before a new run: clears all requests except an emergency stop and a stall, so that one
  /// arriving at this moment is not lost.
  void clear_requests() noexcept {
    requests_.fetch_and(kEmergencyStop | kStall, std::memory_order_acq_rel);
  }

  [[nodiscard]] bool finish_asked() const noexcept { return is_asked(kFinish); }
  [[nodiscard]] bool comfort_stop_asked() const noexcept { return is_asked(kComfortStop); }
  [[nodiscard]] bool emergency_stop_asked() const noexcept { return is_asked(kEmergencyStop); }
  [[nodiscard]] bool stall_seen() const noexcept { return is_asked(kStall); }

 private:
  static constexpr std::uint32_t kFinish = 1;
  static constexpr std::uint32_t kComfortStop = 2;
  static constexpr std::uint32_t kEmergencyStop = 4;
  static constexpr std::uint32_t kStall = 8;
  static_assert(std::atomic<std::uint32_t>::is_always_lock_free, "signal handlers set it");

  void ask(std::uint32_t request) noexcept {
    requests_.fetch_or(request, std::memory_order_acq_rel);
  }
  [[nodiscard]] bool is_asked(std::uint32_t request) const noexcept {
    return (requests_.load(std::memory_order_acquire) & request) != 0;
  }

  std::atomic<std::uint32_t> requests_{0};
};

}  // namespace touchtrial::device
