/// \file What a subject model is held against: answers of participants, or published accuracies.
#pragma once

#include "analysis/planning/answer_model.hpp"
#include "analysis/planning/fit_counts.hpp"

#include <span>
#include <vector>

namespace touchtrial::planning {

/// Derivatives of probabilities by parameters, [parameter][layout][stimulus x classes + answer].
using CellSlopes = std::vector<std::vector<std::vector<double>>>;

/// How likely something that was observed is, given probabilities of answers.
class FitEvidence {
 public:
  virtual ~FitEvidence() = default;

  [[nodiscard]] virtual std::span<const PictureLayout> layouts() const noexcept = 0;
  /// \param table  of those layouts
  /// \param slopes  gets d value / d P, [layout][stimulus x classes + answer], unless null
  [[nodiscard]] virtual double log_likelihood(const AnswerTable& table,
                                              std::vector<std::vector<double>>* slopes) const = 0;
  /// Fisher's information about parameters, row-major.
  /// \param slopes  d P / d parameter, [parameter][layout][cell]
  [[nodiscard]] virtual std::vector<double> information(const AnswerTable& table,
                                                        const CellSlopes& slopes) const = 0;
};

/// Below this no probability of an answer that was given is believed.
inline constexpr double kLeastProbability = 1e-12;

/// Independent multinomial answers, given stimulus and layout. Constants are left out.
class CountsEvidence final : public FitEvidence {
 public:
  /// \param counts  layouts, classes and stimuli; must outlive this
  /// \param people  whose answers they are
  CountsEvidence(const FitCounts& counts, std::span<const CountedPerson> people);

  [[nodiscard]] std::span<const PictureLayout> layouts() const noexcept override {
    return counts_.layouts;
  }
  [[nodiscard]] double log_likelihood(const AnswerTable& table,
                                      std::vector<std::vector<double>>* slopes) const override;
  [[nodiscard]] std::vector<double> information(const AnswerTable& table,
                                                const CellSlopes& slopes) const override;

 private:
  const FitCounts& counts_;
  std::vector<std::vector<double>> sums_;  ///< [layout][cell]
};

/// Accuracies by class, from so many trials each, and nothing else: which wrong answers were given
/// is not known. Layouts, images and methods are presented equally often.
class AccuracyEvidence final : public FitEvidence {
 public:
  /// \param accuracies  by class, 0 .. 1  \param trials_a_class  > 0
  AccuracyEvidence(std::vector<double> accuracies, double trials_a_class,
                   std::vector<PictureLayout> layouts, std::vector<design::StimulusIndex> stimuli);

  [[nodiscard]] std::span<const PictureLayout> layouts() const noexcept override {
    return layouts_;
  }
  [[nodiscard]] double log_likelihood(const AnswerTable& table,
                                      std::vector<std::vector<double>>* slopes) const override;
  [[nodiscard]] std::vector<double> information(const AnswerTable& table,
                                                const CellSlopes& slopes) const override;

  /// The accuracy with each class in a table, over all layouts and stimuli of the class.
  [[nodiscard]] std::vector<double> accuracies_of(const AnswerTable& table) const;

 private:
  [[nodiscard]] double share_of(const design::StimulusIndex& stimulus) const noexcept;

  std::vector<double> accuracies_;
  double trials_;
  std::vector<PictureLayout> layouts_;
  std::vector<design::StimulusIndex> stimuli_;
  std::vector<int> stimuli_of_class_;
};

}  // namespace touchtrial::planning
