/// \file The likelihood of observed answers as a smooth function of a subject's free parameters.
#pragma once

#include "analysis/planning/answer_model.hpp"
#include "analysis/planning/fit_evidence.hpp"
#include "analysis/planning/optimiser.hpp"
#include "protocols/session/subject_model.hpp"

#include <span>
#include <vector>

namespace touchtrial::planning {

/// What is estimated; the rest stays as the subject model has it.
struct FreeParameters {
  bool weber = true;
  bool lapse = true;
  bool position = true;
  bool classes = true;
  bool swaps = true;
};

enum class ParameterKind { weber, lapse, position, class_bias };

struct Parameter {
  ParameterKind kind{};
  int class_index = 0;  ///< of a class bias

  friend bool operator==(const Parameter&, const Parameter&) = default;
};

/// Free parameters as numbers: the logarithm of weber, the lapse, log odds. Class biases add up to
/// 0; one of them, the eliminated one, follows from the others. Refers to model and evidence.
class FitProblem {
 public:
  /// \param subject  what is not free, and the label swaps
  /// \param eliminated  the class whose bias follows from the others
  FitProblem(const AnswerModel& model, const FitEvidence& evidence, session::SubjectModel subject,
             const FreeParameters& free, int eliminated = 0);

  [[nodiscard]] const std::vector<Parameter>& parameters() const noexcept { return parameters_; }
  [[nodiscard]] const Bounds& bounds() const noexcept { return bounds_; }
  /// By how much each number usually matters.
  [[nodiscard]] std::vector<double> scales() const;
  [[nodiscard]] session::SubjectModel subject_at(std::span<const double> at) const;
  /// The numbers of a subject, between the bounds.
  [[nodiscard]] std::vector<double> numbers_of(const session::SubjectModel& subject) const;
  /// The log likelihood, and its derivatives unless `slopes` is empty.
  [[nodiscard]] double value(std::span<const double> at, std::span<double> slopes) const;

  /// d P / d number, [number][layout][cell]. The noise's by a difference, the others' exactly.
  struct Tangent {
    AnswerTable table;
    CellSlopes slopes;
  };
  [[nodiscard]] Tangent tangent(std::span<const double> at, BankPart part = {}) const;

  [[nodiscard]] const AnswerModel& model() const noexcept { return model_; }
  [[nodiscard]] const FitEvidence& evidence() const noexcept { return evidence_; }

 private:
  void add(Parameter parameter, double lower, double upper);
  /// d P / d number of one cell, of all but weber.
  [[nodiscard]] double slope_of(const Parameter& parameter, const AnswerTable& table, int layout,
                                int place, int answer, double lapse_rate, double lapse) const;

  const AnswerModel& model_;
  const FitEvidence& evidence_;
  session::SubjectModel subject_;
  int eliminated_;
  bool classes_free_;
  std::vector<Parameter> parameters_;
  Bounds bounds_;
  std::vector<std::vector<double>> nearness_;  ///< [layout][class] to the first position
};

}  // namespace touchtrial::planning
