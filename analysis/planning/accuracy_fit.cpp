#include "analysis/planning/fit_search.hpp"
#include "analysis/planning/subject_fit.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace touchtrial::planning {
namespace {

/// Scales the likelihood and its tolerance; does not move the maximum.
constexpr double kTrialsPerClass = 100.0;

/// Accuracies by class, without the distribution of wrong answers. Layouts, images and methods are
/// presented equally often.
class AccuracyEvidence final : public FitEvidence {
 public:
  /// \param accuracies  by class, 0 .. 1
  AccuracyEvidence(const std::vector<double>& accuracies, std::vector<PictureLayout> layouts,
                   const std::vector<study::StimulusIndex>& stimuli)
      : accuracies_(accuracies),
        layouts_(std::move(layouts)),
        stimuli_(stimuli),
        stimuli_of_class_(accuracies.size(), 0) {
    for (const study::StimulusIndex& stimulus : stimuli_) ++stimuli_of_class_[stimulus.class_index];
  }

  [[nodiscard]] std::span<const PictureLayout> layouts() const noexcept override {
    return layouts_;
  }
  [[nodiscard]] double log_likelihood(const AnswerTable& table, Cells* slopes) const override;

  /// The accuracy with each class, over all layouts and stimuli of the class.
  [[nodiscard]] std::vector<double> accuracies_of(const AnswerTable& table) const;

 private:
  [[nodiscard]] double weight_of(const study::StimulusIndex& stimulus) const noexcept {
    return 1.0 / (static_cast<double>(layouts_.size()) * stimuli_of_class_[stimulus.class_index]);
  }

  const std::vector<double>& accuracies_;
  std::vector<PictureLayout> layouts_;
  const std::vector<study::StimulusIndex>& stimuli_;
  std::vector<int> stimuli_of_class_;
};

std::vector<double> AccuracyEvidence::accuracies_of(const AnswerTable& table) const {
  std::vector<double> accuracies(accuracies_.size(), 0.0);
  for (std::size_t layout = 0; layout < layouts_.size(); ++layout) {
    for (std::size_t place = 0; place < stimuli_.size(); ++place) {
      const int presented = stimuli_[place].class_index;
      accuracies[presented] +=
          weight_of(stimuli_[place]) *
          table.answers(static_cast<int>(layout), static_cast<int>(place))[presented];
    }
  }
  return accuracies;
}

double AccuracyEvidence::log_likelihood(const AnswerTable& table, Cells* slopes) const {
  const std::vector<double> expected = accuracies_of(table);
  double sum = 0.0;
  std::vector<double> slope(expected.size());
  for (std::size_t c = 0; c < expected.size(); ++c) {
    const double correct = clamped_probability(expected[c]);
    const double wrong = clamped_probability(1.0 - expected[c]);
    sum += kTrialsPerClass *
           (accuracies_[c] * std::log(correct) + (1.0 - accuracies_[c]) * std::log(wrong));
    slope[c] = kTrialsPerClass * (accuracies_[c] / correct - (1.0 - accuracies_[c]) / wrong);
  }
  if (slopes == nullptr) return sum;
  *slopes = zeros(layouts_.size(), table);
  for (std::vector<double>& cells : *slopes) {
    for (std::size_t place = 0; place < stimuli_.size(); ++place) {
      const int presented = stimuli_[place].class_index;
      cells[place * expected.size() + presented] = slope[presented] * weight_of(stimuli_[place]);
    }
  }
  return sum;
}

double saturated_log_likelihood(const std::vector<double>& targets) {
  double sum = 0.0;
  for (const double p : targets) {
    if (p > 0.0) sum += kTrialsPerClass * p * std::log(p);
    if (p < 1.0) sum += kTrialsPerClass * (1.0 - p) * std::log(1.0 - p);
  }
  return sum;
}

void warn_of_misses(AccuracyFit& fit) {
  constexpr double kPoint = 0.01;
  std::string missed_classes;
  for (std::size_t c = 0; c < fit.classes.size(); ++c) {
    if (std::abs(fit.expected_accuracies[c] - fit.targets[c]) <= kPoint) continue;
    missed_classes += (missed_classes.empty() ? "" : ", ") + fit.classes[c];
  }
  if (missed_classes.empty()) return;
  fit.warnings.push_back(
      "no subject model reaches these accuracies; missed by more than a point: " + missed_classes);
}

void warn_of_bounds(const FitProblem& problem, const std::vector<double>& point, AccuracyFit& fit) {
  constexpr double kBoundTolerance = 1e-4;
  const Bounds& bounds = problem.bounds();
  for (std::size_t i = 0; i < point.size(); ++i) {
    const Parameter& parameter = problem.parameters()[i];
    const bool is_lapse = parameter.kind == ParameterKind::lapse;
    const bool at_lower = point[i] - bounds.lower[i] < kBoundTolerance && !is_lapse;
    if (!at_lower && bounds.upper[i] - point[i] >= kBoundTolerance) continue;
    std::string name = "the bias for the first position";
    if (parameter.kind == ParameterKind::feature_noise) name = "feature_noise";
    if (is_lapse) name = "lapse";
    if (parameter.kind == ParameterKind::class_bias) {
      name = "the bias of \"" + fit.classes[parameter.class_index] + "\"";
    }
    fit.warnings.push_back(name + " lies at an end of the searched range");
  }
}

}  // namespace

AccuracyFit fit_accuracies(const AnswerModel& model, std::vector<double> targets,
                           std::vector<PictureLayout> layouts,
                           const simulation::SubjectModel& subject, const FreeParameters& free) {
  const auto impossible = [](double p) { return !(p >= 0.0 && p <= 1.0); };
  if (targets.size() != model.classes().size() || std::ranges::any_of(targets, impossible)) {
    throw std::invalid_argument("fit_accuracies: give one accuracy from 0 to 1 for each class");
  }
  const AccuracyEvidence evidence(targets, std::move(layouts), model.stimuli());
  const FitProblem problem(model, evidence, subject, free);
  const Optimum best = best_of_starts(problem, subject);
  AccuracyFit fit;
  fit.subject = problem.subject_at(best.point);
  fit.classes = model.classes();
  fit.expected_accuracies = evidence.accuracies_of(model.answers(fit.subject, evidence.layouts()));
  fit.parameters = static_cast<int>(best.point.size());
  fit.log_likelihood = best.value;
  fit.best_log_likelihood = saturated_log_likelihood(targets);
  fit.targets = targets;
  warn_of_misses(fit);
  warn_of_bounds(problem, best.point, fit);
  return fit;
}

}  // namespace touchtrial::planning
