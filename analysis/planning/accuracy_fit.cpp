#include "analysis/planning/accuracy_fit.hpp"

#include "analysis/planning/subject_fit.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace touchtrial::planning {
namespace {

/// What they are out of matters little: the accuracies alone decide.
constexpr double kTrialsAClass = 100.0;

double saturated(const std::vector<double>& wanted) {
  double sum = 0.0;
  for (const double p : wanted) {
    if (p > 0.0) sum += kTrialsAClass * p * std::log(p);
    if (p < 1.0) sum += kTrialsAClass * (1.0 - p) * std::log(1.0 - p);
  }
  return sum;
}

void warn_of_misses(AccuracyFit& fit) {
  constexpr double kPoint = 0.01;
  std::string missed;
  for (std::size_t c = 0; c < fit.classes.size(); ++c) {
    if (std::abs(fit.reached[c] - fit.wanted[c]) <= kPoint) continue;
    missed += (missed.empty() ? "" : ", ") + fit.classes[c];
  }
  if (missed.empty()) return;
  fit.warnings.push_back("no subject found has these accuracies: missed by more than a point: " +
                         missed);
}

void warn_of_bounds(const FitProblem& problem, const std::vector<double>& at, AccuracyFit& fit) {
  constexpr double kHair = 1e-4;
  const Bounds& bounds = problem.bounds();
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Parameter& parameter = problem.parameters()[i];
    const bool is_lapse = parameter.kind == ParameterKind::lapse;
    const bool at_lower = at[i] - bounds.lower[i] < kHair && !is_lapse;
    if (!at_lower && bounds.upper[i] - at[i] >= kHair) continue;
    std::string name = "the bias for the first position";
    if (parameter.kind == ParameterKind::weber) name = "weber";
    if (is_lapse) name = "lapse";
    if (parameter.kind == ParameterKind::class_bias) {
      name = "the bias of \"" + fit.classes[parameter.class_index] + "\"";
    }
    fit.warnings.push_back(name + " lies at the end of what is searched");
  }
}

}  // namespace

AccuracyFit fit_accuracies(const AnswerModel& model, std::vector<double> wanted,
                           std::vector<PictureLayout> layouts, const session::SubjectModel& subject,
                           const FreeParameters& free) {
  const auto impossible = [](double p) { return !(p >= 0.0 && p <= 1.0); };
  if (wanted.size() != model.classes().size() || std::ranges::any_of(wanted, impossible)) {
    throw std::invalid_argument("fit_accuracies: one accuracy from 0 to 1 a class");
  }
  const AccuracyEvidence evidence(wanted, kTrialsAClass, std::move(layouts), model.stimuli());
  const FitProblem problem(model, evidence, subject, free);
  const Optimum best = best_of_starts(problem, subject);
  AccuracyFit fit;
  fit.subject = problem.subject_at(best.at);
  fit.classes = model.classes();
  fit.reached = evidence.accuracies_of(model.answers(fit.subject, evidence.layouts()));
  fit.parameters = static_cast<int>(best.at.size());
  fit.log_likelihood = best.value;
  fit.best_log_likelihood = saturated(wanted);
  fit.wanted = std::move(wanted);
  warn_of_misses(fit);
  warn_of_bounds(problem, best.at, fit);
  return fit;
}

}  // namespace touchtrial::planning
