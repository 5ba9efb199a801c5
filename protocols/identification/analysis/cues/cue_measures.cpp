#include "protocols/identification/analysis/cues/cue_measures.hpp"

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace touchtrial::analysis::identification {
namespace {

using Json = nlohmann::ordered_json;

/// \param title  of the column of values
MeasureList<CueFigure> figure_measures(const std::string& title, int digits) {
  using Row = CueFigure;
  return {number_of<Row>("value", title, decimals(digits), &Row::value),
          interval_of<Row>("interval", "95%", range_decimals(digits), &Row::interval)};
}

MeasureList<MeanEstimate> attained_measures() {
  using Row = MeanEstimate;
  return {number_of<Row>("mean", "accuracy", share_figure, &Row::mean),
          interval_of<Row>("interval", "95% (%)", share_range, &Row::known_interval)};
}

std::string_view title_of_observer(const ObserverFigures& observer) {
  return title_of(observer.cue);
}

Json participants_json(const MethodCues& cues) {
  // Sorted by name, because the order of sessions could identify participants of a public report.
  std::map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < cues.participants.size(); ++i) places[cues.participants[i]] = i;
  Json all = Json::array();
  for (const auto& [name, i] : places) {
    Json available;
    for (const ObserverFigures& observer : cues.observers)
      available[name_of(observer.cue)] = observer.accuracy[i];
    all.push_back({{"participant", name},
                   {"n", cues.participant_trials[i]},
                   {"accuracy", cues.human_accuracy[i]},
                   {"available", std::move(available)}});
  }
  return all;
}

MeasureList<CueMatch> match_measures() {
  using Row = CueMatch;
  return {member_of<Row>("best", [](const Row& row) { return name_of(row.best); }),
          member_of<Row>("second", [](const Row& row) { return name_of(row.second); }),
          object_in<Row>("difference_bits", &Row::difference, figure_measures("", 3)),
          member_of<Row>("told_apart", &Row::is_distinct)};
}

Json method_json(const MethodCues& cues) {
  Json human = object_of(cues.human_mean, attained_measures());
  human["confusion"] = cues.human_confusion;
  human["no_response"] = cues.no_response;
  return {
      {"method", cues.method},
      {"trials", cues.trials},
      {"without_trace", cues.without_trace},
      {"unjudged", cues.unjudged},
      {"human", std::move(human)},
      {"observers",
       objects_of(
           cues.observers,
           joined_measures<ObserverFigures>(
               {{member_of<ObserverFigures>(
                     "cue", [](const ObserverFigures& observer) { return name_of(observer.cue); }),
                 member_of<ObserverFigures>("title", title_of_observer)},
                efficiency_measures(),
                divergence_measures()}))},
      {"match", cues.match ? object_of(*cues.match, match_measures()) : Json(nullptr)},
      {"per_participant", participants_json(cues)}};
}

/// The method of each kind of number.
Json by_json() {
  return {
      {"available",
       "ideal observer on each trial's own trace, leave-one-trial-out; mean over participants "
       "with Student's t interval"},
      {"human", "mean over participants with Student's t interval, on the same trials"},
      {"efficiency",
       "mean accuracy over mean available accuracy; expanded percentiles of a cluster bootstrap "
       "over participants, 9,999 draws (Davison, Hinkley 1997; Hesterberg 2015)"},
      {"efficiency_above_chance", "the same after subtracting chance from both"},
      {"divergence_bits",
       "Jensen-Shannon divergence (Lin 1991) of answers to a class, mean over classes, without "
       "trials that have no response; jackknife estimate and interval over participants (Miller "
       "1974)"},
      {"matched",
       "the observer with noise on each felt log intensity (by bisection) that makes it as "
       "accurate as the participants, if possible"},
      {"difference_bits",
       "second smallest divergence of matched observers minus the smallest; the same jackknife; "
       "told_apart only with at least 6 participants, and if the nearest observer can be as "
       "uncertain as they"}};
}

Measure<ObserverFigures> observer_column() {
  return column_of<ObserverFigures>("observer uses", [](const ObserverFigures& observer) {
    return std::string(title_of_observer(observer));
  });
}

}  // namespace

MeasureList<ObserverFigures> efficiency_measures() {
  using Row = ObserverFigures;
  MeasureList<Row> efficiency =
      part_of<Row>("efficiency", &Row::efficiency, figure_measures("efficiency", 2));
  efficiency.front().notes = {
      {"Efficiency: participants' accuracy divided by the observer's; above chance: the same after "
       "subtracting chance from both. Intervals: bootstrap over participants.",
       {Source::davison_hinkley}}};
  return joined_measures<Row>({{observer_column()},
                               part_of<Row>("available", &Row::mean, attained_measures()),
                               std::move(efficiency),
                               part_of<Row>("efficiency_above_chance", &Row::corrected_efficiency,
                                            figure_measures("above chance", 2))});
}

MeasureList<ObserverFigures> divergence_measures(const std::optional<CueMatch>& match) {
  using Row = ObserverFigures;
  MeasureList<Row> matched =
      measures_in<Row>(&Row::matched_divergence, figure_measures("divergence, matched (bit)", 3));
  for (Measure<Row>& measure : matched) measure.member.clear();
  matched.front().cell = [match](const Row& row) {
    return Cell(plain_figure(row.matched_divergence.value, 3), match && match->best == row.cue);
  };
  return joined_measures<Row>(
      {{observer_column().with_note(
           "Divergence: Jensen-Shannon, between participants' and the observer's answers, mean "
           "over textures; 0 if confusions are the same, at most 1. Estimates and intervals: "
           "jackknife over participants, which removes the bias of small counts.",
           {Source::lin, Source::miller_jackknife})},
       part_of<Row>("divergence_bits", &Row::divergence, figure_measures("divergence (bit)", 3)),
       {member_of<Row>("confusion", &Row::confusion),
        column_of<Row>("noise to match",
                       [](const Row& row) {
                         return plain_figure(row.matched_noise, 2) +
                                (row.is_as_uncertain() ? "" : " *");
                       })
            .with_note(
                "Matched: an observer that makes almost no errors has no confusions to compare. It "
                "is given noise (on each felt log intensity) until it is as accurate as the "
                "participants; 0 if it is no more accurate without noise. The smallest divergence "
                "is emphasised."),
        object_in<Row, Row>(
            "matched", std::identity(),
            {number_member<Row>("noise", [](const Row& row) { return row.matched_noise; }),
             object_in<Row>("divergence_bits", &Row::matched_divergence, figure_measures("", 3)),
             member_of<Row>("confusion", &Row::matched_confusion),
             member_of<Row>("accuracy", [](const Row& row) { return row.matched_accuracy; }),
             member_of<Row>("as_uncertain_as_participants", &Row::is_as_uncertain)})},
       std::move(matched)});
}

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
