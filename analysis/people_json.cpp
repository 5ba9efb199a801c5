#include "analysis/json_figures.hpp"
#include "analysis/study_head.hpp"

namespace touchtrial::analysis {
namespace {

using Json = nlohmann::ordered_json;

Json demographics_array(const std::vector<Characteristic>& characteristics) {
  Json all = Json::array();
  for (const Characteristic& one : characteristics) {
    Json bands = Json::array();
    for (const Band& band : one.bands) {
      bands.push_back({{"band", band.name}, {"participants", band.people}});
    }
    all.push_back(
        {{"characteristic", one.name}, {"bands", std::move(bands)}, {"others", one.others}});
  }
  return all;
}

Json explorations_array(const std::vector<Explorations>& methods) {
  Json all = Json::array();
  for (const Explorations& one : methods) {
    all.push_back({{"method", one.method},
                   {"trials", one.trials},
                   {"without_response", one.without_response},
                   {"answer_s", quartiles_json(one.answer_s)},
                   {"contact_s", quartiles_json(one.contact_s)},
                   {"path_mm", quartiles_json(one.path_mm)},
                   {"speed_mm_s", quartiles_json(one.speed_mm_s)},
                   {"force_rms_n", quartiles_json(one.force_n)},
                   {"saturated_share", quartiles_json(one.saturated)}});
  }
  return all;
}

}  // namespace

void put_people(nlohmann::ordered_json& object, const StudyHead& head) {
  object["public"] = head.collection.is_public;
  object["demographics"] = demographics_array(head.demographics);
  object["exploration"] = explorations_array(head.explorations);
}

}  // namespace touchtrial::analysis
