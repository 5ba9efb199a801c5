#include "protocols/identification/analysis/measures_json.hpp"

#include "analysis/json_figures.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

using Json = nlohmann::ordered_json;

void put_mean(Json& object, const MeanEstimate& mean) {
  object["participants"] = mean.participants;
  object["mean"] = figure_json(mean.mean);
  object["interval"] = interval_json(mean.known_interval());
}

Json hits_json(const UnbiasedHits& hits) {
  return {{"mean", figure_json(hits.rate.mean)},
          {"interval", interval_json(hits.rate.known_interval())},
          {"by_chance", figure_json(hits.by_chance)}};
}

Json dependence_json(const SerialDependence& dependence) {
  return {{"wrong", dependence.wrong},
          {"same", dependence.same},
          {"expected", figure_json(dependence.expected)},
          {"p", figure_json(dependence.p)}};
}

Json groups_json(const Breakdown& breakdown) {
  Json groups = Json::array();
  for (const GroupAccuracy& one : breakdown.groups) {
    Json entry{{"group", one.group}};
    put_proportion(entry, one.accuracy);
    entry["wilson"] = interval_json(known(one.wilson, one.accuracy));
    if (one.mean) put_mean(entry, *one.mean);
    groups.push_back(std::move(entry));
  }
  return groups;
}

}  // namespace

nlohmann::ordered_json unbiased_object(const MethodReport& method,
                                       const std::vector<std::string>& classes) {
  if (method.unbiased.empty()) return nullptr;
  Json object = hits_json(method.unbiased.back());
  put_method(object,
             "mean over participants of their unbiased hit rates, the share of a class's "
             "presentations that were answered right times the share of its answers that were "
             "right, averaged over classes, with Student's t interval; by_chance: its mean over "
             "all orders of each participant's presentations, with the same answers",
             {"wagner1993", "student1908"});
  object["classes"] = Json::array();
  for (std::size_t i = 0; i < classes.size(); ++i) {
    Json entry{{"class", classes[i]}};
    entry.update(hits_json(method.unbiased[i]));
    object["classes"].push_back(std::move(entry));
  }
  return object;
}

nlohmann::ordered_json order_object(const std::optional<OrderEffects>& order) {
  if (!order) return nullptr;
  Json object{{"slope",
               {{"mean", figure_json(order->slope.mean)},
                {"interval", interval_json(order->slope.known_interval())},
                {"p", figure_json(order->slope_p)}}},
              {"class_before", dependence_json(order->class_before)},
              {"answer_before", dependence_json(order->answer_before)},
              {"draws", order->draws}};
  put_method(object,
             fmt::format("slope: of right answers on a trial's number within blocks, least "
                         "squares, per trial, mean over participants with Student's t interval; "
                         "class_before and answer_before: wrong answers that name the class "
                         "presented, or the answer given, just before; p two-sided, of {} orders "
                         "that the design could have produced, in which each answer stays with "
                         "its presentation: twice the smaller tail, each (b+1)/(m+1)",
                         order->draws),
             {"student1908", "fischer2014", "phipson2010"});
  return object;
}

nlohmann::ordered_json confidence_object(const std::optional<ConfidenceReport>& confidence) {
  if (!confidence) return nullptr;
  Json ratings = Json::array();
  for (const RatedAccuracy& one : confidence->ratings) {
    Json entry{{"rating", one.rating}};
    put_proportion(entry, one.accuracy);
    put_mean(entry, one.mean);
    ratings.push_back(std::move(entry));
  }
  Json object{{"ratings", std::move(ratings)},
              {"type_2_area",
               {{"participants", confidence->area.participants},
                {"mean", figure_json(confidence->area.mean)},
                {"interval", interval_json(confidence->area.known_interval())},
                {"without", confidence->without_area}}}};
  put_method(object,
             "over answers with a rating; means over the participants who gave it, with Student's "
             "t interval; type_2_area: of participants' own areas, the probability that a right "
             "answer was rated higher than a wrong one, equal ratings counting half",
             {"student1908", "fleming2014"});
  return object;
}

nlohmann::ordered_json reaction_array(const std::vector<ReactionTimes>& reaction,
                                      const std::vector<std::string>& classes) {
  Json all = Json::array();
  for (std::size_t i = 0; i < reaction.size(); ++i) {
    const bool is_class = i < classes.size();
    all.push_back({{"class", is_class ? Json(classes[i]) : Json(nullptr)},
                   {"paused", reaction[i].paused},
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
    put_mean(entry, one.mean);
    all.push_back(std::move(entry));
  }
  return all;
}

}  // namespace touchtrial::analysis::identification
