#include "analysis/json_figures.hpp"
#include "analysis/report/report_sections.hpp"

namespace touchtrial::analysis {
namespace {

using Json = nlohmann::ordered_json;

Json quartiles_json(const Quartiles& quartiles) {
  return {{"n", quartiles.n},
          {"lower_quartile", figure_json(quartiles.lower)},
          {"median", figure_json(quartiles.median)},
          {"upper_quartile", figure_json(quartiles.upper)}};
}

Json groups_json(const Breakdown& breakdown) {
  Json groups = Json::array();
  for (const GroupAccuracy& one : breakdown.groups) {
    Json entry{{"group", one.group}};
    put_proportion(entry, one.accuracy);
    entry["wilson"] = interval_json(known(one.wilson, one.accuracy));
    groups.push_back(std::move(entry));
  }
  return groups;
}

}  // namespace

nlohmann::ordered_json reaction_array(const std::vector<ReactionTimes>& reaction,
                                      const std::vector<std::string>& classes) {
  Json all = Json::array();
  for (std::size_t i = 0; i < reaction.size(); ++i) {
    const bool is_class = i < classes.size();
    all.push_back({{"class", is_class ? Json(classes[i]) : Json(nullptr)},
                   {"from_plane_on", quartiles_json(reaction[i].from_plane_on)},
                   {"from_contact", quartiles_json(reaction[i].from_contact)}});
  }
  return all;
}

nlohmann::ordered_json breakdowns_object(const std::vector<Breakdown>& breakdowns) {
  Json object = Json::object();
  for (const Breakdown& one : breakdowns) object[name_of(one.kind)] = groups_json(one);
  return object;
}

nlohmann::ordered_json robustness_array(const std::vector<SubsetAccuracy>& subsets) {
  Json all = Json::array();
  for (const SubsetAccuracy& one : subsets) {
    Json entry{{"trials", name_of(one.subset)}};
    put_proportion(entry, one.pooled);
    entry["participants"] = one.mean.participants;
    entry["mean"] = figure_json(one.mean.mean);
    entry["interval"] = interval_json(one.mean.known_interval());
    all.push_back(std::move(entry));
  }
  return all;
}

}  // namespace touchtrial::analysis
