/// \file Time that stands still for a watchdog: nothing in a test depends on how fast the machine
/// is.
#pragma once

#include "device/safety/watchdog.hpp"

#include <chrono>
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

}  // namespace touchtrial
