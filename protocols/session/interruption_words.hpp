/// \file What is said of an interrupted exploration: in clear, and sealed.
#pragma once

#include "device/servo/flight_recorder.hpp"
#include "device/servo/servo.hpp"
#include "protocols/store/payload.hpp"

#include <span>
#include <string>

namespace touchtrial {

/// Whether the presentation was spoilt: by a fault, or because somebody asked for it.
[[nodiscard]] bool is_interrupted(const ServoReport& report) noexcept;

/// The reason that anybody may read: what somebody did ("comfort stop", "emergency stop", "device
/// lost"), else "device fault". Faults that follow from forces or motion tell of the texture.
[[nodiscard]] std::string words_in_clear(const ServoReport& report);

/// What is sealed: the faults by name, and the ticks before them.
[[nodiscard]] InterruptionDetail detail_of(const ServoReport& report,
                                           std::span<const FlightTick> ticks);

}  // namespace touchtrial
