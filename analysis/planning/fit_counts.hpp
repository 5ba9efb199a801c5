/// \file The answers that a subject model is fitted to: counts by stimulus, answer and layout.
#pragma once

#include "analysis/outcomes.hpp"
#include "analysis/planning/answer_model.hpp"
#include "protocols/design/schedule.hpp"

#include <map>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::planning {

/// One participant's answers. Not whole numbers only where a population is what is fitted to.
struct CountedPerson {
  int layout = 0;              ///< index into FitCounts::layouts
  std::vector<double> counts;  ///< [stimulus x classes + answer]
};

struct FitCounts {
  std::vector<std::string> classes;            ///< labels
  std::vector<std::string> methods;            ///< of the study
  std::vector<design::StimulusIndex> stimuli;  ///< in the bank's order
  std::vector<PictureLayout> layouts;          ///< each once
  std::vector<CountedPerson> people;
  int trials = 0;       ///< with an answer
  int no_response = 0;  ///< counted trials without one, left out

  [[nodiscard]] int class_count() const noexcept { return static_cast<int>(classes.size()); }
};

/// Counts the trials that enter accuracy (Outcomes: withdrawn, excluded, replaced, stopped and
/// other-kind sessions do not) and have an answer; catch trials do not count.
/// \param schedules  of the sessions, for their layouts
/// \param stimuli  of the study, sorted
/// \throws StudyError if no trial is left
[[nodiscard]] FitCounts count_answers(const analysis::Outcomes& outcomes,
                                      const std::map<int, design::Schedule>& schedules,
                                      const std::vector<design::StimulusIndex>& stimuli);

/// Sums over people: [stimulus x classes + answer] by layout.
[[nodiscard]] std::vector<std::vector<double>> by_layout(const FitCounts& counts,
                                                         std::span<const CountedPerson> people);

/// A table by method, presented class and answer, summed over images and layouts.
using Confusions = std::vector<std::vector<std::vector<double>>>;

/// What was answered.
[[nodiscard]] Confusions observed_confusions(const FitCounts& counts,
                                             std::span<const CountedPerson> people);
/// What a table of probabilities would have the same presentations answered.
[[nodiscard]] Confusions expected_confusions(const FitCounts& counts, const AnswerTable& table);

/// G^2 = 2 sum O ln(O / E): twice the log likelihood that the table falls short of the saturated
/// one. Cells that nothing was answered in add nothing.
[[nodiscard]] double g_squared(const Confusions& observed, const Confusions& expected);

}  // namespace touchtrial::planning
