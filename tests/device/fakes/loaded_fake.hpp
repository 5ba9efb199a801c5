/// \file A fake library as a test holds it: fresh for each test, free or going step by step.
#pragma once

#include "device/platform/dynamic_library.hpp"
#include "device/servo/servo_clock.hpp"
#include "support/catch.hpp"

#include <chrono>
#include <string>
#include <thread>

namespace touchtrial::fakes {

/// Polls until something holds. \return false if it does not within five minutes: something hangs
template <typename Predicate>
[[nodiscard]] bool eventually(Predicate holds) {
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(5);
  while (!holds()) {
    if (std::chrono::steady_clock::now() > give_up) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

/// The library that a driver under test loads too: both see the same state.
template <typename Exports>
class LoadedFake {
 public:
  LoadedFake(const char* file, const char* entry)
      : library_(file, device::Unload::never, "build the tests"),
        exports_(*library_.function<Exports*()>(entry)()) {
    exports_.reset();
    exports_.run_freely();
  }

  [[nodiscard]] auto* operator->() const noexcept { return exports_.state; }
  [[nodiscard]] const Exports& exports() const noexcept { return exports_; }
  [[nodiscard]] std::string calls() const { return exports_.calls(); }

 private:
  device::DynamicLibrary library_;
  Exports& exports_;
};

/// The servo's time is the fake's: a tick of the servo is one of the fake, and nobody else's clock
/// matters. Until it is gone the fake moves in these steps alone.
template <typename Exports>
class SteppingClock final : public device::ServoClock {
 public:
  explicit SteppingClock(const Exports& fake) : fake_(fake) { REQUIRE(fake_.step(1)); }
  ~SteppingClock() override { fake_.run_freely(); }
  SteppingClock(const SteppingClock&) = delete;
  SteppingClock& operator=(const SteppingClock&) = delete;

  [[nodiscard]] Time now() noexcept override { return now_; }
  void wait_until(Time time) noexcept override {
    while (now_ < time) {
      now_ += std::chrono::milliseconds(1);
      hung_ = hung_ || !fake_.step(1);
    }
  }
  [[nodiscard]] bool hung() const noexcept { return hung_; }

 private:
  const Exports& fake_;
  Time now_{};
  bool hung_ = false;
};

}  // namespace touchtrial::fakes
