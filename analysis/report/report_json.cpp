#include "analysis/cues/cues_json.hpp"
#include "analysis/json_figures.hpp"
#include "analysis/report/references.hpp"
#include "analysis/report/report_sections.hpp"

namespace touchtrial::analysis {
namespace {

using Json = nlohmann::ordered_json;

Json comparison_json(const MethodComparison& comparison) {
  return {{"difference", figure_json(comparison.difference)},
          {"interval", interval_json(comparison.known_interval())},
          {"p", figure_json(comparison.p)},
          {"db", figure_json(comparison.db)}};
}

/// The accuracies' intervals, which every method has.
Json intervals_json() {
  Json object;
  put_method(object,
             "95 %, all participants' trials pooled as if independent; p is correct / n, with "
             "trials without a response as wrong",
             {"wilson1927", "clopper1934", "brown2001"});
  return object;
}

Json quantiles_json() {
  Json object;
  put_method(object, "quartiles by definition 7, over trials with a response", {"hyndman1996"});
  return object;
}

}  // namespace

void put_method(nlohmann::ordered_json& object, const std::string& method,
                const std::vector<std::string>& references) {
  object["method"] = method;
  object["references"] = references;
}

nlohmann::ordered_json references_object() {
  Json all = Json::object();
  for (const auto& [key, text] : report_references()) all[std::string(key)] = std::string(text);
  return all;
}

nlohmann::ordered_json registration_object(const design::Registration& registration) {
  return {{"hypothesis", registration.hypothesis},
          {"participants", registration.participants},
          {"stopping_rule", registration.stopping_rule},
          {"exclusions", registration.exclusions},
          {"primary_test", registration.primary_test}};
}

nlohmann::ordered_json report_object(const StudyReport& report) {
  Json object{{"study", report.study}, {"protocol", report.protocol}};
  put_stamp(object, report.simulated);
  put_state(object, report.state, report.pilot);
  object["participants"] = report.participants;
  object["trials"] = report.trials;
  object["classes"] = report.classes;
  object["methods"] = Json::array();
  for (const MethodReport& method : report.methods) {
    object["methods"].push_back(method_object(method, report.classes));
  }
  if (report.comparison) object["comparison"] = comparison_json(*report.comparison);
  object["warnings"] = report.warnings;
  object["pairs"] = pairs_array(report);
  if (report.together) object["together"] = together_object(*report.together);
  object["accuracy_intervals"] = intervals_json();
  object["reaction_times"] = quantiles_json();
  object["registration"] = registration_object(report.registration);
  object["collection"] = collection_object(report.collection);
  if (report.cues) object["cues"] = cues_object(*report.cues);
  object["references"] = references_object();
  return object;
}

std::string report_json(const StudyReport& report) {
  return json_text(report_object(report));
}

}  // namespace touchtrial::analysis
