#include "protocols/session/subject_model_json.hpp"

#include <nlohmann/json.hpp>

namespace touchtrial::session {

std::string subject_model_json(const SubjectModel& model) {
  using Json = nlohmann::ordered_json;
  Json classes = Json::array();
  for (const ClassBias& bias : model.class_bias) {
    classes.push_back({{"label", bias.label}, {"log_odds", bias.log_odds}});
  }
  Json swaps = Json::array();
  for (const auto& [one, other] : model.label_swap) swaps.push_back({one, other});
  const Json subject = {{"weber", model.weber},
                        {"weber_spread", model.weber_spread},
                        {"lapse", model.lapse},
                        {"lapse_spread", model.lapse_spread},
                        {"bias",
                         {{"position", model.position_bias},
                          {"position_spread", model.position_bias_spread},
                          {"classes", std::move(classes)},
                          {"class_spread", model.class_bias_spread}}},
                        {"label_swap", std::move(swaps)},
                        {"explore_s", model.explore_s},
                        {"push_n", model.push_n},
                        {"slowest_mm_s", model.slowest_mm_s},
                        {"fastest_mm_s", model.fastest_mm_s},
                        {"training_passes", model.training_passes}};
  return subject.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace touchtrial::session
