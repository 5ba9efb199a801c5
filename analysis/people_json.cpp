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

Json said_array(const std::vector<QuestionSummary>& questions) {
  Json all = Json::array();
  for (const QuestionSummary& one : questions) {
    Json question{{"question", one.question}, {"wording", one.wording}, {"answered", one.answered}};
    if (one.kind == design::QuestionKind::choice) {
      question["options"] = Json::array();
      for (const Band& option : one.options) {
        question["options"].push_back({{"option", option.name}, {"participants", option.people}});
      }
      question["others"] = one.others;
    } else if (one.kind == design::QuestionKind::number) {
      question["numbers"] = quartiles_json(one.numbers);
    } else {
      question["texts"] = Json::array();
      for (const auto& [participant, text] : one.texts) {
        question["texts"].push_back({{"participant", participant}, {"text", text}});
      }
    }
    all.push_back(std::move(question));
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
  object["said"] = said_array(head.said);
  object["exploration"] = explorations_array(head.explorations);
}

}  // namespace touchtrial::analysis
