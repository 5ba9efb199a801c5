/// \file What is said of an interrupted exploration, in clear and sealed.
#pragma once

#include "device/servo/servo.hpp"

#include <string>
#include <string_view>

namespace touchtrial {

/// Whether the presentation was spoilt: by a fault, or because somebody asked for it.
[[nodiscard]] bool is_interrupted(const ServoReport& report) noexcept;

/// The reason that anybody may read: what somebody did ("comfort stop", "emergency stop", "device
/// lost"), else "device fault". Faults that follow from forces or motion tell of the texture.
[[nodiscard]] std::string words_in_clear(const ServoReport& report);

/// Names of faults as the sealed part has them: the enumerator with hyphens.
[[nodiscard]] std::string_view name_of(SafetyFault fault) noexcept;
[[nodiscard]] std::string_view name_of(DeviceFault fault) noexcept;

}  // namespace touchtrial
