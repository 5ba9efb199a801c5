#include "analysis/report/bibliography.hpp"
#include "analysis/report/json_figures.hpp"
#include "protocols/identification/analysis/cues/cues_json.hpp"
#include "protocols/identification/analysis/method_json.hpp"

namespace touchtrial::analysis::identification {
namespace {

using Json = nlohmann::ordered_json;

Json proportion_json(const Proportion& proportion) {
  Json object;
  put_proportion(object, proportion);
  return object;
}

void put_comparison(Json& object, const MethodComparison& comparison) {
  object["participants"] = comparison.participants;
  object["difference"] = figure_json(comparison.difference);
  object["interval"] = interval_json(comparison.known_interval());
  object["bootstrap"] = interval_json(comparison.bootstrap);
  object["p"] = figure_json(comparison.p);
  object["db"] = figure_json(comparison.db);
}

Json class_json(const ClassComparison& one, const std::string& label) {
  Json object{{"class", label},
              {"first", proportion_json(one.first)},
              {"second", proportion_json(one.second)}};
  put_comparison(object, one.paired);
  object["mcnemar_mid_p"] = figure_json(one.mcnemar_mid_p);
  return object;
}

Json odds_ratio_json(const std::optional<OddsRatio>& ratio) {
  if (!ratio) return nullptr;
  Json object{{"estimate", figure_json(ratio->estimate)},
              {"interval", interval_json(ratio->bootstrap)},
              {"interval_of_trials", interval_json(ratio->interval)}};
  put_method(object,
             "Mantel and Haenszel's common odds ratio, participants as strata; interval: expanded "
             "percentiles of 9,999 draws of participants; interval_of_trials: of Robins, Breslow "
             "and Greenland, which takes trials as independent",
             {"mantel1959", "robins1986", "davison1997", "hesterberg2015"});
  return object;
}

Json pair_json(const MethodPair& pair, const StudyReport& report) {
  Json object{{"first", report.methods[pair.first].method},
              {"second", report.methods[pair.second].method}};
  put_comparison(object, pair.overall);
  object["p_holm"] = figure_json(pair.p_holm);
  object["odds_ratio"] = odds_ratio_json(pair.odds_ratio);
  object["mcnemar_mid_p"] = figure_json(pair.mcnemar_mid_p);
  object["classes"] = Json::array();
  for (std::size_t i = 0; i < pair.classes.size(); ++i) {
    object["classes"].push_back(class_json(pair.classes[i], report.classes[i]));
  }
  put_method(
      object,
      "differences of participants' accuracies, first minus second: t interval, bootstrap "
      "(expanded percentiles of 9,999 draws of participants), p of the two-sided sign-flip "
      "test (exact up to 32 participants, then 99,999 random patterns); db: 10 log10 of the ratio "
      "of "
      "means; p_holm: adjusted over all pairs, with three methods or more; mcnemar_mid_p: "
      "with one pair a participant; p of classes are not adjusted",
      {"student1908", "davison1997", "hesterberg2015", "phipson2010", "holm1979", "fagerland2013"});
  return object;
}

Json comparison_json(const MethodComparison& comparison) {
  return {{"difference", figure_json(comparison.difference)},
          {"interval", interval_json(comparison.known_interval())},
          {"p", figure_json(comparison.p)},
          {"db", figure_json(comparison.db)}};
}

/// The description of the intervals of accuracies, which is the same for every method.
Json intervals_json() {
  Json object;
  put_method(object,
             "wilson, clopper_pearson and jeffreys: 95 %, all participants' trials pooled as if "
             "independent; p is correct / n, with trials without a response as wrong; mean and "
             "interval: of participants' own accuracies, by Student's t",
             {"wilson1927", "clopper1934", "brown2001", "student1908"});
  return object;
}

Json quantiles_json() {
  Json object;
  put_method(object, "quartiles by definition 7, over trials with a response", {"hyndman1996"});
  return object;
}

Json pairs_json(const StudyReport& report) {
  Json all = Json::array();
  for (const MethodPair& pair : report.pairs) all.push_back(pair_json(pair, report));
  return all;
}

Json together_json(const MethodsTogether& together) {
  Json object{{"q", figure_json(together.cochran.q)},
              {"degrees_of_freedom", together.cochran.degrees_of_freedom},
              {"p", figure_json(together.cochran.p)},
              {"permuted_p", figure_json(together.permuted_p)}};
  put_method(object,
             "Cochran's Q over occasions (participant, class, n-th presentation); p under "
             "chi-square takes occasions as independent; permuted_p exchanges methods within "
             "participants, Monte Carlo over 9,999 deals, (b+1)/(m+1)",
             {"cochran1950", "phipson2010"});
  return object;
}

}  // namespace

std::string report_json(const StudyReport& report) {
  Json object = head_object(report);
  object["classes"] = report.classes;
  object["methods"] = Json::array();
  for (const MethodReport& method : report.methods) {
    object["methods"].push_back(method_object(method, report.classes));
  }
  if (report.comparison) object["comparison"] = comparison_json(*report.comparison);
  object["warnings"] = report.warnings;
  object["pairs"] = pairs_json(report);
  if (report.together) object["together"] = together_json(*report.together);
  object["accuracy_intervals"] = intervals_json();
  object["reaction_times"] = quantiles_json();
  object["registration"] = registration_object(report.registration);
  object["collection"] = collection_object(report.collection);
  if (report.cues) object["cues"] = cues_object(*report.cues);
  object["references"] = references_object();
  put_registered(object, report);
  put_people(object, report);
  return json_text(object);
}

}  // namespace touchtrial::analysis::identification
