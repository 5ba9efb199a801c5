/// \file The parts that the fake libraries share: a hand on the device, the pace of their thread, a
/// log of calls.
#pragma once

#include "core/vec.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace touchtrial::fakes {

/// A vector that a test and a fake's thread share; each coordinate is atomic by itself.
class SharedVec {
 public:
  void set(Vec3 v) noexcept {
    x_.store(v.x, std::memory_order_relaxed);
    y_.store(v.y, std::memory_order_relaxed);
    z_.store(v.z, std::memory_order_relaxed);
  }
  [[nodiscard]] Vec3 get() const noexcept {
    return {x_.load(std::memory_order_relaxed), y_.load(std::memory_order_relaxed),
            z_.load(std::memory_order_relaxed)};
  }

 private:
  std::atomic<double> x_{0.0};
  std::atomic<double> y_{0.0};
  std::atomic<double> z_{0.0};
};

/// Moves through thick oil in steps of a millisecond: velocity = (push + force) / damping. Against
/// a wall it settles where the wall carries the push. All accesses are relaxed, so that they order
/// nothing for the driver.
class FakeHand {
 public:
  static constexpr double kDampingNSPerMm = 0.008;
  static constexpr double kStepS = 0.001;

  void step(Vec3 force_n) noexcept {
    const Vec3 velocity_mm_s = (1.0 / kDampingNSPerMm) * (push_n.get() + force_n);
    velocity.set(velocity_mm_s);
    position_mm.set(position_mm.get() + kStepS * velocity_mm_s);
  }
  void rest_at(Vec3 place_mm) noexcept {
    push_n.set({});
    velocity.set({});
    position_mm.set(place_mm);
  }

  SharedVec push_n;
  SharedVec position_mm;
  SharedVec velocity;  ///< mm/s
};

/// Paces a fake's thread: free, or step by step by a test.
class Pace {
 public:
  /// Fake's thread, before each step.
  /// \return false if the fake has to stop
  [[nodiscard]] bool begin_step() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return stopping_ || free_ || permits_ > 0; });
    if (stopping_) return false;
    if (!free_) --permits_;
    const bool sleeps = free_;
    lock.unlock();
    if (sleeps) std::this_thread::sleep_for(std::chrono::microseconds(200));
    return true;
  }
  void end_step() {
    const std::lock_guard lock(mutex_);
    ++done_;
    changed_.notify_all();
  }

  /// Test's thread: lets the fake make this many steps and no more.
  /// \return false if they hang
  [[nodiscard]] bool step(int steps) {
    std::unique_lock lock(mutex_);
    free_ = false;
    permits_ = steps;
    const long goal = done_ + steps;
    changed_.notify_all();
    return changed_.wait_for(lock, std::chrono::minutes(5), [&] { return done_ >= goal; });
  }
  void run_freely() {
    const std::lock_guard lock(mutex_);
    free_ = true;
    changed_.notify_all();
  }

  void stop() {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    changed_.notify_all();
  }
  void start() {
    const std::lock_guard lock(mutex_);
    stopping_ = false;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool free_ = true;
  bool stopping_ = false;
  int permits_ = 0;
  long done_ = 0;
};

/// The names of opening and closing calls, in order. Any thread may use it.
class CallLog {
 public:
  void note(const char* call) {
    const std::lock_guard lock(mutex_);
    text_ += std::string(call) + ' ';
  }
  [[nodiscard]] std::string text() const {
    const std::lock_guard lock(mutex_);
    return text_;
  }
  void clear() {
    const std::lock_guard lock(mutex_);
    text_.clear();
  }

 private:
  mutable std::mutex mutex_;
  std::string text_;
};

}  // namespace touchtrial::fakes
