#include "analysis/planning/fit_report.hpp"
#include "analysis/text_figures.hpp"
#include "analysis/text_table.hpp"

#include <cmath>

#include <fmt/format.h>

namespace touchtrial::planning {
namespace {

std::string end_text(std::optional<double> end) {
  return end ? fmt::format("{:.3f}", *end) : "open";
}

std::string title_of(const ParameterEstimate& estimate) {
  if (estimate.name == "weber") return "noise (weber)";
  if (estimate.name == "position") return "bias: first position";
  return estimate.label.empty() ? estimate.name : "bias: " + estimate.label;
}

std::string estimates_text(const SubjectFit& fit, const FitOrigin& origin) {
  analysis::TextTable table(
      {"parameter", "estimate", "95 %, profile", "95 %, simulated studies", "error of the bank"});
  for (const ParameterEstimate& one : fit.estimates) {
    const std::string simulated =
        one.bootstrap ? fmt::format("[{:.3f}, {:.3f}]", one.bootstrap->low, one.bootstrap->high)
                      : "-";
    // Of weber, its logarithm's error is meant.
    const double error = one.monte_carlo_error * (one.name == "weber" ? one.value : 1.0);
    table.add({title_of(one), fmt::format("{:.3f}", one.value),
               fmt::format("[{}, {}]", end_text(one.profile.lower), end_text(one.profile.upper)),
               simulated, one.standard_error ? fmt::format("{:.3f}", error) : "-"});
  }
  return analysis::heading("what the answers tell of who gave them", origin.simulated) +
         table.text();
}

std::string swap_text(const SubjectFit& fit) {
  std::string text;
  for (const SwapCandidate& one : fit.swaps) {
    text += analysis::wrapped(
        "  ", fmt::format("pictures of \"{}\" and \"{}\" exchanged: log likelihood "
                          "{:+.1f}, {:.1f} needed: {}",
                          one.labels.first, one.labels.second, one.gain, fit.swap_threshold,
                          one.taken ? "taken" : "not taken"));
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
  return analysis::heading(fit.methods[method] + ": answers, and what the fit expects of them",
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

std::string biases_text(const session::SubjectModel& subject) {
  std::string text = fmt::format("weber {:.4f}, lapse {:.4f}, bias for the first position {:+.3f}",
                                 subject.weber, subject.lapse, subject.position_bias);
  for (const session::ClassBias& bias : subject.class_bias) {
    text += fmt::format(", for {} {:+.3f}", bias.label, bias.log_odds);
  }
  return text;
}

}  // namespace

std::string fit_text(const SubjectFit& fit, const FitOrigin& origin) {
  std::string text = analysis::simulated_line(origin.simulated);
  text += fmt::format(
      "{}: {}, {} with an answer{}{}{}\n", origin.study,
      analysis::counted(fit.participants, "participant"), analysis::counted(fit.trials, "trial"),
      fit.no_response > 0 ? fmt::format(", {} without left out", fit.no_response) : "",
      origin.pilot ? ", PILOT" : "", origin.interim ? ", INTERIM LOOK" : "");
  text += estimates_text(fit, origin) + swap_text(fit);
  for (std::size_t m = 0; m < fit.methods.size(); ++m) text += confusion_text(fit, m, origin);
  text += goodness_text(fit);
  if (!fit.warnings.empty()) text += analysis::heading("to bear in mind", origin.simulated);
  for (const std::string& warning : fit.warnings) text += analysis::wrapped("  - ", warning);
  return text + analysis::simulated_line(origin.simulated);
}

std::string fit_text(const AccuracyFit& fit, const FitOrigin& origin) {
  std::string text = origin.study + ": a subject for published accuracies\n";
  analysis::TextTable table({"class", "published", "expected of the fit", "difference, points"});
  for (std::size_t c = 0; c < fit.classes.size(); ++c) {
    table.add({fit.classes[c], analysis::percent_of_share(fit.wanted[c]),
               analysis::percent_of_share(fit.reached[c]),
               fmt::format("{:+.2f}", 100.0 * (fit.reached[c] - fit.wanted[c]))});
  }
  text += table.text() + analysis::wrapped("  ", biases_text(fit.subject));
  const bool others_fit = fit.warnings.empty();
  text += analysis::wrapped(
      "  ", fmt::format("{} parameters for {} numbers{}", fit.parameters, fit.classes.size(),
                        others_fit ? ": other subjects fit as well, see docs/fitting.md" : ""));
  if (!fit.warnings.empty()) text += analysis::heading("to bear in mind", origin.simulated);
  for (const std::string& warning : fit.warnings) text += analysis::wrapped("  - ", warning);
  return text;
}

}  // namespace touchtrial::planning
