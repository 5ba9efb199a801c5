#include "analysis/json_figures.hpp"
#include "analysis/report/report.hpp"

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using Json = nlohmann::ordered_json;

Json counts_json(const ConfusionMatrix& confusion) {
  Json rows = Json::array();
  for (int i = 0; i < confusion.classes(); ++i) {
    Json row = Json::array();
    for (int j = 0; j < confusion.classes(); ++j) row.push_back(confusion.count(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

Json no_response_json(const ConfusionMatrix& confusion) {
  Json column = Json::array();
  for (int i = 0; i < confusion.classes(); ++i) column.push_back(confusion.no_response(i));
  return column;
}

/// Adds n, correct and p to an object that may have begun with a name.
void put_proportion(Json& object, const Proportion& proportion) {
  object["n"] = proportion.n;
  object["correct"] = proportion.correct;
  object["p"] = figure_json(proportion.share());
}

Json classes_json(const MethodReport& method, const std::vector<std::string>& classes) {
  Json all = Json::array();
  for (std::size_t i = 0; i < classes.size(); ++i) {
    const ClassAccuracy& one = method.accuracy[i];
    Json entry{{"class", classes[i]}};
    put_proportion(entry, one.accuracy);
    entry["wilson"] = interval_json(one.wilson);
    entry["clopper_pearson"] = interval_json(one.clopper_pearson);
    all.push_back(std::move(entry));
  }
  return all;
}

Json participants_json(const MethodReport& method) {
  Json all = Json::array();
  for (const ParticipantAccuracy& one : method.per_participant) {
    Json entry{{"participant", one.participant}};
    put_proportion(entry, one.accuracy);
    all.push_back(std::move(entry));
  }
  return all;
}

Json method_json(const MethodReport& method, const std::vector<std::string>& classes) {
  Json overall;
  put_proportion(overall, method.overall);
  overall["mean"] = figure_json(method.mean.mean);
  overall["interval"] = interval_json(method.mean.interval);
  const InformationTransfer& information = method.information;
  return {{"method", method.method},
          {"confusion", counts_json(method.confusion)},
          {"no_response", no_response_json(method.confusion)},
          {"accuracy", classes_json(method, classes)},
          {"overall", overall},
          {"information_transfer",
           {{"raw", figure_json(information.raw)},
            {"corrected", figure_json(information.corrected)},
            {"null_mean", figure_json(information.null_mean)}}},
          {"per_participant", participants_json(method)}};
}

Json comparison_json(const MethodComparison& comparison) {
  return {{"difference", figure_json(comparison.difference)},
          {"interval", interval_json(comparison.interval)},
          {"p", figure_json(comparison.p)},
          {"db", figure_json(comparison.db)}};
}

}  // namespace

nlohmann::ordered_json report_object(const StudyReport& report) {
  Json object{{"study", report.study}, {"protocol", report.protocol}};
  put_stamp(object, report.simulated);
  object["participants"] = report.participants;
  object["trials"] = report.trials;
  object["classes"] = report.classes;
  object["methods"] = Json::array();
  for (const MethodReport& method : report.methods) {
    object["methods"].push_back(method_json(method, report.classes));
  }
  if (report.comparison) object["comparison"] = comparison_json(*report.comparison);
  object["warnings"] = report.warnings;
  return object;
}

std::string report_json(const StudyReport& report) {
  return json_text(report_object(report));
}

}  // namespace touchtrial
