#include "analysis/planning/fit_report.hpp"
#include "protocols/session/subject_model_json.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

namespace touchtrial::planning {
namespace {

using Json = nlohmann::ordered_json;

Json number(std::optional<double> value) {
  if (!value || !std::isfinite(*value)) return nullptr;
  return *value;
}

Json origin_json(const FitOrigin& origin) {
  Json object = {{"study", origin.study}, {"subject", origin.subject}};
  object["simulated"] = origin.simulated;
  if (origin.simulated) object["stamp"] = "SIMULATED";
  object["pilot"] = origin.pilot;
  object["interim"] = origin.interim;
  object["bank"] = {{"explorations", origin.explorations},
                    {"directions", origin.directions},
                    {"seed", origin.seed}};
  return object;
}

Json estimate_json(const ParameterEstimate& estimate) {
  Json object = {{"name", estimate.name}};
  if (!estimate.label.empty()) object["label"] = estimate.label;
  object["value"] = estimate.value;
  // Of weber, its logarithm's errors are known.
  const double unit = estimate.name == "weber" ? estimate.value : 1.0;
  object["standard_error"] = nullptr;
  if (estimate.standard_error) object["standard_error"] = number(*estimate.standard_error * unit);
  object["profile"] = {number(estimate.profile.lower), number(estimate.profile.upper)};
  object["bootstrap"] = nullptr;
  if (estimate.bootstrap) {
    object["bootstrap"] = {estimate.bootstrap->low, estimate.bootstrap->high};
  }
  object["monte_carlo_error"] = number(estimate.monte_carlo_error * unit);
  object["at_bound"] = estimate.at_bound;
  return object;
}

Json estimates_json(const SubjectFit& fit) {
  Json all = Json::array();
  for (const ParameterEstimate& one : fit.estimates) all.push_back(estimate_json(one));
  return all;
}

Json swaps_json(const SubjectFit& fit) {
  Json tried = Json::array();
  for (const SwapCandidate& one : fit.swaps) {
    tried.push_back({{"labels", {one.labels.first, one.labels.second}},
                     {"gain", one.gain},
                     {"taken", one.taken}});
  }
  return {{"threshold", fit.swap_threshold}, {"tried", std::move(tried)}};
}

Json confusions_json(const SubjectFit& fit) {
  Json all = Json::array();
  for (std::size_t m = 0; m < fit.methods.size(); ++m) {
    all.push_back(
        {{"method", fit.methods[m]}, {"observed", fit.observed[m]}, {"expected", fit.expected[m]}});
  }
  return all;
}

std::string shown(const Json& object) {
  return object.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string fit_json(const SubjectFit& fit, const FitOrigin& origin) {
  Json object = origin_json(origin);
  object["participants"] = fit.participants;
  object["trials"] = fit.trials;
  object["no_response"] = fit.no_response;
  object["classes"] = fit.classes;
  object["fitted"] = Json::parse(session::subject_model_json(fit.subject));
  object["estimates"] = estimates_json(fit);
  object["weber_lapse_correlation"] = number(fit.weber_lapse_correlation);
  object["label_swaps"] = swaps_json(fit);
  object["log_likelihood"] = number(fit.log_likelihood);
  object["goodness_of_fit"] = {{"g_squared", number(fit.g_squared)},
                               {"degrees_of_freedom", fit.degrees_of_freedom},
                               {"p", number(fit.p)},
                               {"bootstraps", fit.bootstraps}};
  object["confusions"] = confusions_json(fit);
  object["warnings"] = fit.warnings;
  return shown(object);
}

std::string fit_json(const AccuracyFit& fit, const FitOrigin& origin) {
  Json object = origin_json(origin);
  Json classes = Json::array();
  for (std::size_t c = 0; c < fit.classes.size(); ++c) {
    classes.push_back(
        {{"class", fit.classes[c]}, {"wanted", fit.wanted[c]}, {"reached", fit.reached[c]}});
  }
  object["accuracies"] = std::move(classes);
  object["parameters"] = fit.parameters;
  object["log_likelihood"] = number(fit.log_likelihood);
  object["best_log_likelihood"] = number(fit.best_log_likelihood);
  object["warnings"] = fit.warnings;
  object["fitted"] = Json::parse(session::subject_model_json(fit.subject));
  return shown(object);
}

}  // namespace touchtrial::planning
