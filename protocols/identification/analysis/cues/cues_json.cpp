#include "protocols/identification/analysis/cues/cues_json.hpp"

#include "analysis/report/json_figures.hpp"

#include <map>
#include <string>

namespace touchtrial::analysis::identification {

namespace {

using Json = nlohmann::ordered_json;

Json cue_figure_json(const CueFigure& figure) {
  return {{"value", figure_json(figure.value)}, {"interval", interval_json(figure.interval)}};
}

Json mean_json(const MeanEstimate& mean) {
  Json object;
  put_mean(object, mean);
  return object;
}

Json participants_json(const MethodCues& cues) {
  // Sorted by name, because the order of sessions could identify participants of a public report.
  std::map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < cues.participants.size(); ++i) places[cues.participants[i]] = i;
  Json all = Json::array();
  for (const auto& [name, i] : places) {
    Json available;
    for (const ObserverFigures& one : cues.observers) available[name_of(one.cue)] = one.accuracy[i];
    all.push_back({{"participant", name},
                   {"n", cues.participant_trials[i]},
                   {"accuracy", cues.human_accuracy[i]},
                   {"available", std::move(available)}});
  }
  return all;
}

Json observers_json(const MethodCues& cues) {
  return array_json(cues.observers, [](const ObserverFigures& one) {
    return Json{{"cue", name_of(one.cue)},
                {"title", title_of(one.cue)},
                {"available", mean_json(one.mean)},
                {"efficiency", cue_figure_json(one.efficiency)},
                {"efficiency_above_chance", cue_figure_json(one.corrected_efficiency)},
                {"divergence_bits", cue_figure_json(one.divergence)},
                {"confusion", one.confusion},
                {"matched",
                 {{"noise", one.matched_noise},
                  {"divergence_bits", cue_figure_json(one.matched_divergence)},
                  {"confusion", one.matched_confusion},
                  {"accuracy", one.matched_accuracy},
                  {"as_uncertain_as_participants", one.is_as_uncertain()}}}};
  });
}

Json match_json(const std::optional<CueMatch>& match) {
  if (!match) return nullptr;
  return {{"best", name_of(match->best)},
          {"second", name_of(match->second)},
          {"difference_bits", cue_figure_json(match->difference)},
          {"told_apart", match->is_distinct}};
}

Json method_json(const MethodCues& cues) {
  Json human = mean_json(cues.human_mean);
  human["confusion"] = cues.human_confusion;
  human["no_response"] = cues.no_response;
  return {{"method", cues.method},
          {"trials", cues.trials},
          {"without_trace", cues.without_trace},
          {"unjudged", cues.unjudged},
          {"human", std::move(human)},
          {"observers", observers_json(cues)},
          {"match", match_json(cues.match)},
          {"per_participant", participants_json(cues)}};
}

/// The method by which each kind of number is computed.
Json by_json() {
  return {
      {"available",
       "ideal observer on each trial's own trace, leave-one-trial-out; mean over participants "
       "with Student's t interval"},
      {"human", "mean over participants with Student's t interval, on the same trials"},
      {"efficiency",
       "mean accuracy over mean available accuracy; expanded percentiles of a cluster bootstrap "
       "over participants, 9,999 draws (Davison, Hinkley 1997; Hesterberg 2015)"},
      {"efficiency_above_chance", "the same with chance taken from both"},
      {"divergence_bits",
       "Jensen-Shannon divergence (Lin 1991) of answers to a class, mean over classes, trials "
       "without a response left out; estimate and interval of the jackknife over participants "
       "(Miller 1974)"},
      {"matched",
       "the observer with the noise of each felt log intensity (by bisection) that makes it "
       "right as often as the participants, if there is one"},
      {"difference_bits",
       "second least divergence of matched observers less the least; the same jackknife; "
       "told_apart only from 6 participants on, and if the nearest observer can be as uncertain as "
       "they"}};
}

}  // namespace

nlohmann::ordered_json cues_object(const CueReport& report) {
  Json object;
  put_stamp(object, report.simulated);
  object["classes"] = report.classes;
  object["chance"] = report.chance;
  object["methods"] = array_json(report.methods, method_json);
  object["by"] = by_json();
  object["plane_from"] = report.plane_source;
  object["warnings"] = report.warnings;
  return object;
}

}  // namespace touchtrial::analysis::identification
