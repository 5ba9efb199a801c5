/// \file Lock-free transfer of the newest value from one thread to another.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace touchtrial::device {

/// A triple buffer for one writer and one reader, each on its own thread. Neither ever blocks the
/// other. The reader gets the newest complete value, and may miss earlier ones.
template <typename T>
class LatestValue {
  static_assert(std::is_trivially_copyable_v<T>, "copies must not allocate");
  static_assert(std::atomic<std::uint8_t>::is_always_lock_free);

 public:
  explicit LatestValue(const T& first = {}) : slots_{first, first, first} {}

  /// Call it on the writer's thread.
  void set(const T& value) noexcept {
    slots_[back_] = value;
    back_ = shared_.exchange(back_ | kFresh, std::memory_order_acq_rel) & kIndex;
  }

  /// Call it on the reader's thread.
  /// \return the newest value; the previous one again if there is none newer
  [[nodiscard]] const T& get() noexcept {
    if ((shared_.load(std::memory_order_relaxed) & kFresh) != 0) {
      front_ = shared_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    }
    return slots_[front_];
  }

 private:
  static constexpr std::uint8_t kFresh = 4;
  static constexpr std::uint8_t kIndex = 3;

  std::array<T, 3> slots_;
  std::uint8_t back_ = 0;                ///< the writer's slot
  std::atomic<std::uint8_t> shared_{1};  ///< the slot between them, and whether it is fresh
  std::uint8_t front_ = 2;               ///< the reader's slot
};

}  // namespace touchtrial::device
