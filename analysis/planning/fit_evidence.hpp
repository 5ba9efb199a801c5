/// \file The data that a subject model is fitted to: counts of answers by stimulus, layout and
/// class, and their likelihood.
#pragma once

#include "analysis/outcomes/outcomes.hpp"
#include "analysis/planning/answer_model.hpp"
#include "study/schedule.hpp"

#include <map>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::planning {

/// One participant's answers. Counts are whole numbers unless they represent a population.
struct CountedPerson {
  int layout = 0;              ///< index into FitCounts::layouts
  std::vector<double> counts;  ///< [stimulus x classes + answer]
};

struct FitCounts {
  std::vector<std::string> classes;           ///< labels
  std::vector<std::string> methods;           ///< of the study
  std::vector<study::StimulusIndex> stimuli;  ///< in the bank's order
  std::vector<PictureLayout> layouts;         ///< each once
  std::vector<CountedPerson> people;
  int trials = 0;       ///< with an answer
  int no_response = 0;  ///< counted trials without an answer, which are left out
};

/// Counts the answered trials that enter accuracy, without catch trials. Outcomes already omits
/// erased, excluded, replaced and stopped sessions, and sessions of another kind.
/// \param schedules  of the sessions, for their layouts
/// \param stimuli  of the study, sorted
/// \throws StudyError if no trial remains
[[nodiscard]] FitCounts count_answers(const analysis::Outcomes& outcomes,
                                      const std::map<int, study::Schedule>& schedules,
                                      const std::vector<study::StimulusIndex>& stimuli);

/// Numbers by layout and cell of a table, [layout][stimulus x classes + answer].
using Cells = std::vector<std::vector<double>>;

/// The number of presentations of one stimulus: the sum of its answers.
/// \param row  the stimulus's first cell
[[nodiscard]] double presentations(const std::vector<double>& cells, std::size_t row,
                                   std::size_t classes);

/// \return sums over people
[[nodiscard]] Cells counts_by_layout(const FitCounts& counts,
                                     std::span<const CountedPerson> people);

/// A table by method, presented class and answer, summed over images and layouts.
using Confusions = std::vector<std::vector<std::vector<double>>>;

[[nodiscard]] Confusions observed_confusions(const FitCounts& counts,
                                             std::span<const CountedPerson> people);
/// \return the answers that the table's probabilities predict for the same presentations
[[nodiscard]] Confusions expected_confusions(const FitCounts& counts, const AnswerTable& table);

/// G^2 = 2 sum O ln(O / E), over cells with O > 0: twice the difference in log likelihood from the
/// saturated model.
[[nodiscard]] double g_squared(const Confusions& observed, const Confusions& expected);

/// The likelihood of an observation, given probabilities of answers.
class FitEvidence {
 public:
  virtual ~FitEvidence() = default;

  [[nodiscard]] virtual std::span<const PictureLayout> layouts() const noexcept = 0;
  /// \param table  the probabilities for layouts()
  /// \param slopes  null, or receives the derivatives with respect to the table's probabilities
  [[nodiscard]] virtual double log_likelihood(const AnswerTable& table, Cells* slopes) const = 0;
};

/// The minimum probability of an observed answer, which keeps its logarithm finite.
inline constexpr double kMinProbability = 1e-12;

/// \return the probability, between kMinProbability and 1
[[nodiscard]] double clamped_probability(double probability) noexcept;

/// \return the table's probabilities
[[nodiscard]] Cells cells_of(const AnswerTable& table, const FitCounts& counts);

/// \return a zero for every cell of the table
[[nodiscard]] Cells zeros(std::size_t layouts, const AnswerTable& table);

/// Multinomial answers, independent given stimulus and layout. The log likelihood leaves out
/// constants.
class CountsEvidence final : public FitEvidence {
 public:
  /// \param counts  layouts, classes and stimuli; must outlive this object
  /// \param people  the people whose answers count
  CountsEvidence(const FitCounts& counts, std::span<const CountedPerson> people);

  [[nodiscard]] std::span<const PictureLayout> layouts() const noexcept override {
    return counts_.layouts;
  }
  [[nodiscard]] double log_likelihood(const AnswerTable& table, Cells* slopes) const override;

 private:
  const FitCounts& counts_;
  Cells sums_;  ///< counts_by_layout
};

}  // namespace touchtrial::planning
