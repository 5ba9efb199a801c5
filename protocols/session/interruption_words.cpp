#include "protocols/session/interruption_words.hpp"

#include "device/servo/servo_names.hpp"

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

InterruptionDetail detail_of(const ServoReport& report, std::span<const FlightTick> ticks) {
  return {.safety_fault = std::string(name_of(report.fault)),
          .device_fault = std::string(name_of(report.device_fault)),
          .ticks = static_cast<std::int64_t>(ticks.size()),
          .flight = flight_csv(ticks)};
}

}  // namespace touchtrial
