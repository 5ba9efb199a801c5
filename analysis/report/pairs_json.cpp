#include "analysis/json_figures.hpp"
#include "analysis/report/report_sections.hpp"

namespace touchtrial::analysis {
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
              {"interval", interval_json(ratio->interval)}};
  put_method(object,
             "Mantel and Haenszel's common odds ratio, participants as strata; interval of Robins, "
             "Breslow and Greenland",
             {"mantel1959", "robins1986"});
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

}  // namespace

nlohmann::ordered_json pairs_array(const StudyReport& report) {
  Json all = Json::array();
  for (const MethodPair& pair : report.pairs) all.push_back(pair_json(pair, report));
  return all;
}

nlohmann::ordered_json together_object(const MethodsTogether& together) {
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

}  // namespace touchtrial::analysis
