#include "protocols/session/interruption_words.hpp"

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

}  // namespace touchtrial
