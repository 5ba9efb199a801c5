/// \file Who lets a fake's thread go on: itself, freely, or a test, step by step.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace touchtrial::fakes {

class Pace {
 public:
  /// Fake's thread, before each step. \return false if the fake is to stop
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

  /// Test's thread: so many steps more, and nothing after them. \return false if they hang
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

}  // namespace touchtrial::fakes
