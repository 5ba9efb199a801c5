#include "analysis/planning/fit_problem.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::planning {
namespace {

// Beyond these bounds, answers are perfect, at chance, or all the same.
constexpr double kMinFeatureNoise = 1e-3;
constexpr double kMaxFeatureNoise = 10.0;
constexpr double kMaxLogOdds = 20.0;
/// The step of ln(feature_noise) for the derivative.
constexpr double kStep = 2e-4;

double bias_of(const simulation::SubjectModel& subject, const std::string& label) {
  double bias = 0.0;
  for (const simulation::ClassBias& preferred : subject.class_bias) {
    if (preferred.label == label) bias += preferred.log_odds;
  }
  return bias;
}

/// d mean lapse / d lapse.
double lapse_slope(simulation::SubjectModel subject) {
  if (subject.lapse_spread == 0.0) return 1.0;
  constexpr double kLapseStep = 1e-5;
  const double base_lapse = mean_lapse(subject);
  subject.lapse += kLapseStep;
  return (mean_lapse(subject) - base_lapse) / kLapseStep;
}

}  // namespace

FitProblem::FitProblem(const AnswerModel& model, const FitEvidence& evidence,
                       simulation::SubjectModel subject, const FreeParameters& free, int eliminated)
    : model_(model),
      evidence_(evidence),
      subject_(std::move(subject)),
      eliminated_(eliminated),
      classes_free_(free.classes) {
  // Without any noise, the probabilities would be step functions.
  subject_.feature_noise = std::max(subject_.feature_noise, kMinFeatureNoise);
  if (free.feature_noise)
    add({ParameterKind::feature_noise}, std::log(kMinFeatureNoise), std::log(kMaxFeatureNoise));
  if (free.lapse) add({ParameterKind::lapse}, 0.0, kMaxLapse);
  if (free.position) add({ParameterKind::position}, -kMaxLogOdds, kMaxLogOdds);
  const auto classes = static_cast<int>(model_.classes().size());
  for (int c = 0; free.classes && c < classes; ++c) {
    if (c != eliminated_) add({ParameterKind::class_bias, c}, -kMaxLogOdds, kMaxLogOdds);
  }
  for (const PictureLayout& layout : evidence_.layouts()) nearness_.push_back(nearness_of(layout));
}

void FitProblem::add(Parameter parameter, double lower, double upper) {
  parameters_.push_back(parameter);
  bounds_.lower.push_back(lower);
  bounds_.upper.push_back(upper);
}

std::vector<double> FitProblem::scales() const {
  constexpr double kNoise = 0.1;
  constexpr double kLapse = 0.03;
  constexpr double kBias = 0.3;
  std::vector<double> scales;
  for (const Parameter& parameter : parameters_) {
    const bool is_noise = parameter.kind == ParameterKind::feature_noise;
    const bool is_lapse = parameter.kind == ParameterKind::lapse;
    scales.push_back(is_noise ? kNoise : is_lapse ? kLapse : kBias);
  }
  return scales;
}

simulation::SubjectModel FitProblem::subject_at(std::span<const double> point) const {
  simulation::SubjectModel subject = subject_;
  std::vector<double> biases(model_.classes().size(), 0.0);
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    const Parameter& parameter = parameters_[i];
    if (parameter.kind == ParameterKind::feature_noise) subject.feature_noise = std::exp(point[i]);
    if (parameter.kind == ParameterKind::lapse) subject.lapse = point[i];
    if (parameter.kind == ParameterKind::position) subject.position_bias = point[i];
    if (parameter.kind == ParameterKind::class_bias) {
      biases[parameter.class_index] = point[i];
      biases[eliminated_] -= point[i];
    }
  }
  if (!classes_free_) return subject;
  subject.class_bias.clear();
  for (std::size_t c = 0; c < biases.size(); ++c) {
    subject.class_bias.push_back({model_.classes()[c], biases[c]});
  }
  return subject;
}

std::vector<double> FitProblem::numbers_of(const simulation::SubjectModel& subject) const {
  double mean = 0.0;
  for (const std::string& label : model_.classes()) {
    mean += bias_of(subject, label) / static_cast<double>(model_.classes().size());
  }
  std::vector<double> numbers;
  for (const Parameter& parameter : parameters_) {
    switch (parameter.kind) {
      case ParameterKind::feature_noise:
        numbers.push_back(std::log(std::max(subject.feature_noise, kMinFeatureNoise)));
        break;
      case ParameterKind::lapse:
        numbers.push_back(subject.lapse);
        break;
      case ParameterKind::position:
        numbers.push_back(subject.position_bias);
        break;
      case ParameterKind::class_bias:
        numbers.push_back(bias_of(subject, model_.classes()[parameter.class_index]) - mean);
        break;
    }
  }
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = std::clamp(numbers[i], bounds_.lower[i], bounds_.upper[i]);
  }
  return numbers;
}

double FitProblem::slope_of(const Parameter& parameter, const AnswerTable& table, int layout,
                            int place, int answer, double lapse_derivative, double lapse) const {
  const auto classes = static_cast<std::size_t>(table.classes());
  if (parameter.kind == ParameterKind::lapse) {
    const double chance = 1.0 / static_cast<double>(classes);
    const double felt_probability =
        (table.answers(layout, place)[answer] - lapse * chance) / (1.0 - lapse);
    return lapse_derivative * (chance - felt_probability);
  }
  const auto bias_slopes = table.slopes(layout, place).subspan(answer * classes, classes);
  if (parameter.kind == ParameterKind::class_bias) {
    return bias_slopes[parameter.class_index] - bias_slopes[eliminated_];
  }
  double sum = 0.0;
  for (std::size_t c = 0; c < classes; ++c) sum += bias_slopes[c] * nearness_[layout][c];
  return sum;
}

Optimum FitProblem::maximise_from(std::vector<double> start, const Bounds& bounds,
                                  const OptimiserOptions& options) const {
  return maximise([this](std::span<const double> point,
                         std::span<double> slopes) { return value(point, slopes); },
                  std::move(start), bounds, options);
}

FitProblem::Tangent FitProblem::tangent(std::span<const double> point, BankPart part) const {
  const simulation::SubjectModel subject = subject_at(point);
  const std::span<const PictureLayout> layouts = evidence_.layouts();
  Tangent tangent{model_.answers(subject, layouts, true, part), {}};
  const AnswerTable& table = tangent.table;
  const int classes = table.classes();
  const auto cells = static_cast<std::size_t>(table.stimuli()) * classes;
  const double mean_lapse_slope = lapse_slope(subject);
  const double lapse = mean_lapse(subject);
  simulation::SubjectModel noisier_subject = subject;
  noisier_subject.feature_noise *= std::exp(kStep);
  const bool noise_is_free =
      std::ranges::count(parameters_, Parameter{ParameterKind::feature_noise}) > 0;
  const AnswerTable noisier_table =
      noise_is_free ? model_.answers(noisier_subject, layouts, false, part) : table;
  for (const Parameter& parameter : parameters_) {
    auto& slopes = tangent.slopes.emplace_back(layouts.size(), std::vector<double>(cells));
    for (int layout = 0; layout < static_cast<int>(layouts.size()); ++layout) {
      for (std::size_t cell = 0; cell < cells; ++cell) {
        const int place = static_cast<int>(cell) / classes;
        const int answer = static_cast<int>(cell) % classes;
        slopes[layout][cell] =
            parameter.kind == ParameterKind::feature_noise
                ? (noisier_table.answers(layout, place)[answer] -
                   table.answers(layout, place)[answer]) /
                      kStep
                : slope_of(parameter, table, layout, place, answer, mean_lapse_slope, lapse);
      }
    }
  }
  return tangent;
}

double FitProblem::value(std::span<const double> point, std::span<double> slopes) const {
  if (slopes.empty()) {
    return evidence_.log_likelihood(model_.answers(subject_at(point), evidence_.layouts()),
                                    nullptr);
  }
  const Tangent local_tangent = tangent(point);
  Cells cell_slopes;
  const double value = evidence_.log_likelihood(local_tangent.table, &cell_slopes);
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    slopes[i] = 0.0;
    for (std::size_t layout = 0; layout < cell_slopes.size(); ++layout) {
      for (std::size_t cell = 0; cell < cell_slopes[layout].size(); ++cell) {
        slopes[i] += cell_slopes[layout][cell] * local_tangent.slopes[i][layout][cell];
      }
    }
  }
  return value;
}

}  // namespace touchtrial::planning
