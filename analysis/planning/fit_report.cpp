#include "analysis/planning/fit_report.hpp"

#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "analysis/report/text_table.hpp"
#include "core/strict_json.hpp"
#include "protocols/simulation/subject_model.hpp"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::planning {
namespace {

std::string end_text(std::optional<double> end) {
  return end ? fmt::format("{:.3f}", *end) : "open";
}

std::string title_of(const ParameterEstimate& estimate) {
  if (estimate.name == "feature_noise") return "noise of features";
  if (estimate.name == "position") return "bias: first position";
  return estimate.label.empty() ? estimate.name : "bias: " + estimate.label;
}

std::string estimates_text(const SubjectFit& fit, const FitOrigin& origin) {
  analysis::TextTable table(
      {"parameter", "estimate", "95 %, profile", "95 %, simulated studies", "error of the bank"});
  for (const ParameterEstimate& estimate : fit.estimates) {
    const std::string simulated =
        estimate.bootstrap
            ? fmt::format("[{:.3f}, {:.3f}]", estimate.bootstrap->low, estimate.bootstrap->high)
            : "-";
    // The error applies to ln(feature_noise).
    const double error =
        estimate.monte_carlo_error * (estimate.name == "feature_noise" ? estimate.value : 1.0);
    table.add({title_of(estimate), fmt::format("{:.3f}", estimate.value),
               fmt::format("[{}, {}]", end_text(estimate.profile.lower),
                           end_text(estimate.profile.upper)),
               simulated, estimate.standard_error ? fmt::format("{:.3f}", error) : "-"});
  }
  return analysis::heading("what the answers reveal about the participants", origin.simulated) +
         table.text();
}

std::string people_text(const SubjectFit& fit) {
  if (!fit.people) return "";
  const PeopleSpread& people = *fit.people;
  return analysis::wrapped(
      "  ", fmt::format("spread of noise between people: {:.3f}, 95 % [{}, {}]; no spread: p = {}; "
                        "the subject's spread of {:.3f}: p = {}, {}",
                        people.spread, end_text(people.interval.lower),
                        end_text(people.interval.upper), analysis::p_value(people.equal_p),
                        fit.assumed_spread, analysis::p_value(people.assumed_p),
                        fit.spread_replaced ? "replaced by the estimate" : "kept"));
}

std::string swap_text(const SubjectFit& fit) {
  std::string text;
  for (const SwapCandidate& candidate : fit.swaps) {
    text += analysis::wrapped(
        "  ",
        fmt::format(
            "pictures of \"{}\" and \"{}\" swapped: log likelihood {:+.1f}, {:.1f} needed: {}",
            candidate.labels.first, candidate.labels.second, candidate.gain, fit.swap_threshold,
            candidate.accepted ? "taken" : "not taken"));
  }
  return text;
}

std::string confusion_text(const SubjectFit& fit, std::size_t method, const FitOrigin& origin) {
  std::vector<std::string> header{"presented"};
  for (const std::string& label : fit.classes) header.push_back(label);
  analysis::TextTable table(std::move(header));
  for (std::size_t c = 0; c < fit.classes.size(); ++c) {
    std::vector<std::string> row{fit.classes[c]};
    for (std::size_t a = 0; a < fit.classes.size(); ++a) {
      row.push_back(
          fmt::format("{:.0f} ({:.1f})", fit.observed[method][c][a], fit.expected[method][c][a]));
    }
    table.add(std::move(row));
  }
  return analysis::heading(
             fit.methods[method] + ": observed answers, and those expected from the fit",
             origin.simulated) +
         table.text();
}

std::string goodness_text(const SubjectFit& fit) {
  std::string text =
      fmt::format("G^2 = {:.1f} with {} cells left", fit.g_squared, fit.degrees_of_freedom);
  if (fit.p) {
    text += fmt::format(", p = {} (of {} studies simulated from the fit)",
                        analysis::p_value(*fit.p), fit.bootstraps);
  }
  return analysis::wrapped("  ", text);
}

std::string biases_text(const simulation::SubjectModel& subject) {
  std::string text =
      fmt::format("feature_noise {:.4f}, lapse {:.4f}, bias for the first position {:+.3f}",
                  subject.feature_noise, subject.lapse, subject.position_bias);
  for (const simulation::ClassBias& bias : subject.class_bias) {
    text += fmt::format(", for {} {:+.3f}", bias.label, bias.log_odds);
  }
  return text;
}

/// States the device of simulated answers, if any, and the device of the explorations, which are
/// always simulated.
std::string device_lines(const FitOrigin& origin) {
  return analysis::simulated_on_line(origin.answers_on) +
         (origin.felt_on.empty() ? "" : "explorations ") +
         analysis::simulated_on_line(origin.felt_on);
}

using Json = nlohmann::ordered_json;

Json number(std::optional<double> value) {
  if (!value || !std::isfinite(*value)) return nullptr;
  return *value;
}

Json origin_json(const FitOrigin& origin) {
  Json object = {{"study", origin.study}, {"subject", origin.subject}};
  object["simulated"] = origin.simulated;
  if (origin.simulated) object["stamp"] = "SIMULATED";
  if (!origin.answers_on.empty()) object["simulated_on"] = origin.answers_on;
  object["pilot"] = origin.pilot;
  object["interim"] = origin.interim;
  object["bank"] = {{"simulated_on", origin.felt_on},
                    {"explorations", origin.explorations},
                    {"directions", origin.directions},
                    {"seed", origin.seed}};
  return object;
}

Json estimate_json(const ParameterEstimate& estimate) {
  Json object = {{"name", estimate.name}};
  if (!estimate.label.empty()) object["label"] = estimate.label;
  object["value"] = estimate.value;
  // The errors apply to ln(feature_noise).
  const double unit = estimate.name == "feature_noise" ? estimate.value : 1.0;
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
  for (const ParameterEstimate& estimate : fit.estimates) all.push_back(estimate_json(estimate));
  return all;
}

Json people_json(const SubjectFit& fit) {
  if (!fit.people) return nullptr;
  const PeopleSpread& people = *fit.people;
  return {{"spread", people.spread},
          {"interval", {number(people.interval.lower), number(people.interval.upper)}},
          {"alike_p", people.equal_p},
          {"given_spread", fit.assumed_spread},
          {"given_p", people.assumed_p},
          {"taken", fit.spread_replaced}};
}

/// Null for the default, ideal device.
Json device_json(const device::DeviceModel& model) {
  return model.name.empty() ? Json() : Json::parse(device::device_model_json(model));
}

/// Each simulated study's subject, by kDrawnKeys.
Json draws_json(const SubjectFit& fit) {
  Json all = Json::array();
  for (const simulation::SubjectModel& subject : fit.draws) {
    const Json subject_object = Json::parse(simulation::subject_model_json(subject));
    Json drawn;
    for (const std::string_view key : kDrawnKeys) drawn[std::string(key)] = subject_object.at(key);
    all.push_back(std::move(drawn));
  }
  return all;
}

Json swaps_json(const SubjectFit& fit) {
  Json candidates = Json::array();
  for (const SwapCandidate& candidate : fit.swaps) {
    candidates.push_back({{"labels", {candidate.labels.first, candidate.labels.second}},
                          {"gain", candidate.gain},
                          {"taken", candidate.accepted}});
  }
  return {{"threshold", fit.swap_threshold}, {"tried", std::move(candidates)}};
}

Json confusions_json(const SubjectFit& fit) {
  Json all = Json::array();
  for (std::size_t m = 0; m < fit.methods.size(); ++m) {
    all.push_back(
        {{"method", fit.methods[m]}, {"observed", fit.observed[m]}, {"expected", fit.expected[m]}});
  }
  return all;
}

}  // namespace

std::string fit_text(const SubjectFit& fit, const FitOrigin& origin) {
  std::string text = device_lines(origin) + analysis::simulated_line(origin.simulated);
  text += fmt::format(
      "{}: {}, {} with an answer{}{}{}\n", origin.study,
      analysis::counted(fit.participants, "participant"), analysis::counted(fit.trials, "trial"),
      fit.no_response > 0 ? fmt::format(", {} without left out", fit.no_response) : "",
      origin.pilot ? ", PILOT" : "", origin.interim ? ", INTERIM LOOK" : "");
  text += estimates_text(fit, origin) + people_text(fit) + swap_text(fit);
  for (std::size_t m = 0; m < fit.methods.size(); ++m) text += confusion_text(fit, m, origin);
  text += goodness_text(fit);
  if (!fit.warnings.empty()) text += analysis::heading("to bear in mind", origin.simulated);
  for (const std::string& warning : fit.warnings) text += analysis::wrapped("  - ", warning);
  return text + analysis::simulated_line(origin.simulated);
}

std::string fit_text(const AccuracyFit& fit, const FitOrigin& origin) {
  std::string text = device_lines(origin) + origin.study + ": a subject for published accuracies\n";
  analysis::TextTable table({"class", "published", "expected from the fit", "difference, points"});
  for (std::size_t c = 0; c < fit.classes.size(); ++c) {
    table.add({fit.classes[c], analysis::share_figure(fit.targets[c]),
               analysis::share_figure(fit.expected_accuracies[c]),
               fmt::format("{:+.2f}", 100.0 * (fit.expected_accuracies[c] - fit.targets[c]))});
  }
  text += table.text() + analysis::wrapped("  ", biases_text(fit.subject));
  const bool others_fit = fit.warnings.empty();
  text += analysis::wrapped(
      "  ",
      fmt::format("{} parameters for {} numbers{}", fit.parameters, fit.classes.size(),
                  others_fit ? ": other subjects fit equally well, see docs/planning.md" : ""));
  if (!fit.warnings.empty()) text += analysis::heading("to bear in mind", origin.simulated);
  for (const std::string& warning : fit.warnings) text += analysis::wrapped("  - ", warning);
  return text;
}

std::string fit_json(const SubjectFit& fit, const FitOrigin& origin) {
  Json object = origin_json(origin);
  object["participants"] = fit.participants;
  object["trials"] = fit.trials;
  object["no_response"] = fit.no_response;
  object["classes"] = fit.classes;
  object["fitted"] = Json::parse(simulation::subject_model_json(fit.subject));
  object["device"] = device_json(fit.subject.device);
  object["draws"] = draws_json(fit);
  object["estimates"] = estimates_json(fit);
  object["noise_lapse_correlation"] = number(fit.noise_lapse_correlation);
  object["differences_between_people"] = people_json(fit);
  object["label_swaps"] = swaps_json(fit);
  object["log_likelihood"] = number(fit.log_likelihood);
  object["goodness_of_fit"] = {{"g_squared", number(fit.g_squared)},
                               {"degrees_of_freedom", fit.degrees_of_freedom},
                               {"p", number(fit.p)},
                               {"bootstraps", fit.bootstraps}};
  object["confusions"] = confusions_json(fit);
  object["warnings"] = fit.warnings;
  return json_text(object);
}

std::string fit_json(const AccuracyFit& fit, const FitOrigin& origin) {
  Json object = origin_json(origin);
  Json classes = Json::array();
  for (std::size_t c = 0; c < fit.classes.size(); ++c) {
    classes.push_back({{"class", fit.classes[c]},
                       {"wanted", fit.targets[c]},
                       {"reached", fit.expected_accuracies[c]}});
  }
  object["accuracies"] = std::move(classes);
  object["parameters"] = fit.parameters;
  object["log_likelihood"] = number(fit.log_likelihood);
  object["best_log_likelihood"] = number(fit.best_log_likelihood);
  object["warnings"] = fit.warnings;
  object["fitted"] = Json::parse(simulation::subject_model_json(fit.subject));
  return json_text(object);
}

}  // namespace touchtrial::planning
