#include "protocols/session/interruption_words.hpp"

#include <array>

namespace touchtrial {

bool is_interrupted(const ServoReport& report) noexcept {
  return report.end == ServoEnd::fault || report.end == ServoEnd::comfort_stop;
}

std::string words_in_clear(const ServoReport& report) {
  if (report.end == ServoEnd::comfort_stop) return "comfort stop";
  if (report.fault == SafetyFault::emergency_stop) return "emergency stop";
  if (report.device_fault == DeviceFault::link_lost) return "device lost";
  return "device fault";
}

std::string_view name_of(SafetyFault fault) noexcept {
  constexpr std::array<std::string_view, 8> kNames = {"none",      "not-finite", "emergency-stop",
                                                      "not-ready", "overspeed",  "stale-sample",
                                                      "stalled",   "device"};
  static_assert(kNames.size() == static_cast<std::size_t>(SafetyFault::device) + 1);
  return kNames[static_cast<std::size_t>(fault)];
}

std::string_view name_of(DeviceFault fault) noexcept {
  constexpr std::array<std::string_view, 6> kNames = {"none",        "link-lost",    "bad-data",
                                                      "warm-motors", "limit-passed", "driver"};
  static_assert(kNames.size() == static_cast<std::size_t>(DeviceFault::driver) + 1);
  return kNames[static_cast<std::size_t>(fault)];
}

}  // namespace touchtrial
