/// \file Waiting for a participant's window, instead of for a time that is long enough for it.
#pragma once

#include "app/participant/participant_window.hpp"

#include <chrono>
#include <cstdint>
#include <stdexcept>
#include <thread>

namespace touchtrial {

/// Waits until the window's main thread has taken all that VirtualScreen has done so far; on
/// another thread. \throws std::runtime_error if it has not within a minute
inline void wait_until_heard(const app::ParticipantWindow& window) {
  // The pump that is under way may have looked before; the one after it has not.
  const std::int64_t wanted = window.pumps() + 2;
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (window.pumps() < wanted) {
    if (std::chrono::steady_clock::now() > give_up) throw std::runtime_error("nobody pumps");
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace touchtrial
