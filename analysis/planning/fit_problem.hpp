/// \file The log likelihood as a smooth function of a subject's free parameters.
#pragma once

#include "analysis/planning/answer_model.hpp"
#include "analysis/planning/fit_evidence.hpp"
#include "analysis/planning/optimiser.hpp"
#include "protocols/simulation/subject_model.hpp"

#include <span>
#include <vector>

namespace touchtrial::planning {

/// The maximum lapse rate; beyond it, answers are at chance.
inline constexpr double kMaxLapse = 0.98;

/// The parameters to estimate; the others keep their values from the subject model.
struct FreeParameters {
  bool feature_noise = true;
  bool lapse = true;
  bool position = true;
  bool classes = true;
  bool swaps = true;
  bool spread = true;  ///< of noise between people, estimated from each participant's answers
};

enum class ParameterKind { feature_noise, lapse, position, class_bias };

struct Parameter {
  ParameterKind kind{};
  int class_index = 0;  ///< only for a class bias

  friend bool operator==(const Parameter&, const Parameter&) = default;
};

/// Free parameters as numbers: ln(feature_noise), the lapse, and biases as log odds. The class
/// biases sum to 0, so one of them, the eliminated one, follows from the others. Keeps references
/// to model and evidence, which must outlive it.
class FitProblem {
 public:
  /// \param subject  values of the fixed parameters, and the label swaps
  /// \param eliminated  index of the class whose bias follows from the others
  FitProblem(const AnswerModel& model, const FitEvidence& evidence,
             simulation::SubjectModel subject, const FreeParameters& free, int eliminated = 0);

  [[nodiscard]] const std::vector<Parameter>& parameters() const noexcept { return parameters_; }
  [[nodiscard]] const Bounds& bounds() const noexcept { return bounds_; }
  /// Typical sizes of the numbers' changes.
  [[nodiscard]] std::vector<double> scales() const;
  [[nodiscard]] simulation::SubjectModel subject_at(std::span<const double> point) const;
  /// The numbers of a subject, clamped to the bounds.
  [[nodiscard]] std::vector<double> numbers_of(const simulation::SubjectModel& subject) const;
  /// The log likelihood.
  /// \param slopes  empty, or receives the derivatives
  [[nodiscard]] double value(std::span<const double> point, std::span<double> slopes) const;

  /// Searches for the largest log likelihood from a start.
  [[nodiscard]] Optimum maximise_from(std::vector<double> start, const Bounds& bounds,
                                      const OptimiserOptions& options) const;

  /// Probabilities and their derivatives with respect to each number: a finite difference for the
  /// noise, exact for the others.
  struct Tangent {
    AnswerTable table;
    std::vector<Cells> slopes;  ///< by number
  };
  [[nodiscard]] Tangent tangent(std::span<const double> point, BankPart part = {}) const;

  [[nodiscard]] const AnswerModel& model() const noexcept { return model_; }

 private:
  void add(Parameter parameter, double lower, double upper);
  /// d P / d number for one cell, for any parameter other than feature_noise.
  [[nodiscard]] double slope_of(const Parameter& parameter, const AnswerTable& table, int layout,
                                int place, int answer, double lapse_derivative, double lapse) const;

  const AnswerModel& model_;
  const FitEvidence& evidence_;
  simulation::SubjectModel subject_;
  int eliminated_;
  bool classes_free_;
  std::vector<Parameter> parameters_;
  Bounds bounds_;
  std::vector<std::vector<double>> nearness_;  ///< by layout: nearness_of
};

}  // namespace touchtrial::planning
