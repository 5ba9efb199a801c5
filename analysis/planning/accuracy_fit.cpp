#include "analysis/planning/accuracy_fit.hpp"

#include "analysis/planning/subject_fit.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace touchtrial {
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

}  // namespace

AccuracyFit fit_accuracies(const AnswerModel& model, std::vector<double> wanted,
                           std::vector<PictureLayout> layouts, const SubjectModel& subject,
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
  return fit;
}

}  // namespace touchtrial
