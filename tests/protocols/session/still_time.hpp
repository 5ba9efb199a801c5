/// \file Real time for tests that must not depend on the machine's speed: a watchdog's time that
/// stands still, and an explorer whose servo runs as fast as the processor allows.
#pragma once

#include "device/safety/watchdog.hpp"
#include "protocols/session/real_time_explorer.hpp"

#include <chrono>
#include <memory>
#include <thread>

namespace touchtrial {

class StillTime final : public device::WatchdogTime {
 public:
  [[nodiscard]] Time now() noexcept override { return {}; }
  void pause(Time) noexcept override { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }
};

[[nodiscard]] inline device::WatchdogTime& still_time() noexcept {
  static StillTime time;
  return time;
}

[[nodiscard]] inline session::RealTimeOptions as_fast_as_it_goes() {
  session::RealTimeOptions options;
  options.scheduling.policy = device::SchedulingPolicy::other;
  options.scheduling.lock_memory = false;
  options.watchdog_time = &still_time();
  options.clock = [] { return std::make_unique<device::VirtualClock>(); };
  return options;
}

}  // namespace touchtrial
