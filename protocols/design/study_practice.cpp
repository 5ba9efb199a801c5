/// The study file's "practice".
#include "protocols/design/study_sections.hpp"

namespace touchtrial::design {

PracticePlan read_practice(const JsonValue& place) {
  const JsonObject object = place.object({"classes", "criterion", "rounds"});
  PracticePlan practice;
  practice.classes = read_classes(object.at("classes"), 1);
  if (const auto member = object.find("criterion")) {
    practice.criterion = static_cast<int>(member->integer(0, 100));
  }
  if (const auto member = object.find("rounds")) {
    practice.rounds = static_cast<int>(member->integer(1, 10));
  }
  return practice;
}

nlohmann::json to_json(const PracticePlan& practice) {
  nlohmann::json classes = nlohmann::json::array();
  for (const StudyClass& shown : practice.classes) {
    classes.push_back({{"label", shown.label}, {"images", {shown.images.front().string()}}});
  }
  return {{"classes", classes}, {"criterion", practice.criterion}, {"rounds", practice.rounds}};
}

}  // namespace touchtrial::design
