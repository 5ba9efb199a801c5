/// \file A subject model whose accuracies are some published ones. Source: docs/fitting.md,
/// "Published accuracies".
#pragma once

#include "analysis/planning/answer_model.hpp"
#include "analysis/planning/fit_problem.hpp"

#include <string>
#include <vector>

namespace touchtrial::planning {

struct AccuracyFit {
  session::SubjectModel subject;
  std::vector<std::string> classes;
  std::vector<double> wanted;   ///< by class, 0 .. 1
  std::vector<double> reached;  ///< likewise, expected of the fitted subject
  int parameters = 0;           ///< that were estimated
  double log_likelihood = 0.0;
  double best_log_likelihood = 0.0;  ///< of anything that reaches the accuracies
  std::vector<std::string> warnings;
};

/// The subject whose accuracies are the most likely, by binomial likelihood of equally many trials
/// with each class. With as many parameters as classes there are usually many that reach them
/// exactly, of which this is one. Label swaps stay the subject's.
/// \param wanted  by class, 0 .. 1  \param layouts  of the participants
/// \throws std::invalid_argument if there are not as many as classes, or one is out of range
[[nodiscard]] AccuracyFit fit_accuracies(const AnswerModel& model, std::vector<double> wanted,
                                         std::vector<PictureLayout> layouts,
                                         const session::SubjectModel& subject,
                                         const FreeParameters& free);

}  // namespace touchtrial::planning
