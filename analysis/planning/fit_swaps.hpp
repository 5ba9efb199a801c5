/// \file Whether people matched two pictures to each other's feelings.
#pragma once

#include "analysis/planning/subject_fit.hpp"

#include <vector>

namespace touchtrial::planning {

/// A subject with the label swaps that the answers call for, all else fitted.
struct SwapSearch {
  session::SubjectModel subject;
  double log_likelihood = 0.0;
  std::vector<SwapCandidate> candidates;
  double threshold = 0.0;
};

/// Adds pairs one by one. Every pair of labels that is in no swap yet is tried on a coarse grid of
/// noise and lapse, the two best are fitted, and the better is taken if its log likelihood is more
/// than ln(20 x pairs) above that without it: the answers are then 20 times likelier than without a
/// swap even if, beforehand, one swap of any pair was no likelier than none at all.
/// \param subject  where the search starts; its own swaps are left out of it
[[nodiscard]] SwapSearch search_swaps(const AnswerModel& model, const FitEvidence& evidence,
                                      session::SubjectModel subject, const FreeParameters& free);

/// The gain of log likelihood that one of so many pairs needs.
[[nodiscard]] double swap_threshold(int pairs) noexcept;

}  // namespace touchtrial::planning
