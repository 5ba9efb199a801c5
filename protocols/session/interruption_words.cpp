#include "protocols/session/interruption_words.hpp"

#include "device/servo/servo_names.hpp"

namespace touchtrial::session {

bool is_interrupted(const device::ServoReport& report) noexcept {
  return report.end == device::ServoEnd::fault || report.end == device::ServoEnd::comfort_stop;
}

std::string words_in_clear(const device::ServoReport& report) {
  if (report.end == device::ServoEnd::comfort_stop) return "comfort stop";
  if (report.fault == device::SafetyFault::emergency_stop) return "emergency stop";
  if (report.device_fault == device::DeviceFault::link_lost) return "device lost";
  return "device fault";
}

store::InterruptionDetail detail_of(const device::ServoReport& report,
                                    std::span<const device::FlightTick> ticks) {
  return {.safety_fault = std::string(device::name_of(report.fault)),
          .device_fault = std::string(device::name_of(report.device_fault)),
          .ticks = static_cast<std::int64_t>(ticks.size()),
          .flight = device::flight_csv(ticks)};
}

}  // namespace touchtrial::session
