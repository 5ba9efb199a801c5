/// \file What files and reports call the states of the servo: lower case, words by underscores.
#pragma once

#include "device/platform/realtime.hpp"
#include "device/servo/servo.hpp"

#include <string_view>

namespace touchtrial::device {

[[nodiscard]] std::string_view name_of(ServoEnd end) noexcept;
[[nodiscard]] std::string_view name_of(SafetyVerdict verdict) noexcept;
[[nodiscard]] std::string_view name_of(SafetyFault fault) noexcept;
[[nodiscard]] std::string_view name_of(DeviceFault fault) noexcept;
[[nodiscard]] std::string_view name_of(SchedulingPolicy policy) noexcept;

}  // namespace touchtrial::device
