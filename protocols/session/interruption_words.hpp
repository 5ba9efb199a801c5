/// \file What is said of an interrupted exploration: in clear, and sealed.
#pragma once

#include "device/servo/flight_recorder.hpp"
#include "device/servo/servo.hpp"
#include "protocols/store/payload.hpp"

#include <span>
#include <string>

namespace touchtrial::session {

/// Whether the presentation was spoilt: by a fault, or because somebody asked for it.
[[nodiscard]] bool is_interrupted(const device::ServoReport& report) noexcept;

/// The reason that anybody may read: what somebody did ("comfort stop", "emergency stop", "device
/// lost"), else "device fault". Faults that follow from forces or motion tell of the texture.
[[nodiscard]] std::string words_in_clear(const device::ServoReport& report);

/// What is sealed: the faults by name, and the ticks before them.
[[nodiscard]] store::InterruptionDetail detail_of(const device::ServoReport& report,
                                                  std::span<const device::FlightTick> ticks);

}  // namespace touchtrial::session
