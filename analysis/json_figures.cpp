#include "analysis/json_figures.hpp"

namespace touchtrial {

nlohmann::ordered_json figure_json(std::optional<double> figure) {
  if (!figure) return nullptr;
  return *figure;
}

nlohmann::ordered_json interval_json(const Interval& interval) {
  return nlohmann::ordered_json::array({interval.low, interval.high});
}

void put_stamp(nlohmann::ordered_json& object, bool simulated) {
  object["simulated"] = simulated;
  if (simulated) object["stamp"] = "SIMULATED";
}

nlohmann::ordered_json statistics_json(const GlcmStatistics& statistics) {
  return {{"asm", statistics.angular_second_moment},
          {"energy", statistics.energy},
          {"entropy", statistics.entropy},
          {"contrast", statistics.contrast},
          {"correlation", statistics.correlation}};
}

std::string json_text(const nlohmann::ordered_json& object) {
  using ErrorHandler = nlohmann::ordered_json::error_handler_t;
  return object.dump(2, ' ', false, ErrorHandler::replace) + '\n';
}

}  // namespace touchtrial
