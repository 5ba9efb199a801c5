/// \file The search for the most likely subject: starting points and label swaps.
/// Private to analysis/planning. Source: docs/planning.md, "Estimates".
#pragma once

#include "analysis/planning/fit_problem.hpp"
#include "analysis/planning/subject_fit.hpp"

#include <vector>

namespace touchtrial::planning {

/// \return the better of two searches: one from the subject, one from the best point of a grid of
///   noise and lapse
[[nodiscard]] Optimum best_of_starts(const FitProblem& problem,
                                     const simulation::SubjectModel& subject);

/// The gain in log likelihood required to accept a label swap: ln(20 x pairs).
/// \param pairs  number of pairs of labels that could be swapped
[[nodiscard]] double swap_threshold(int pairs) noexcept;

/// A fitted subject with the label swaps that the answers support.
struct SwapSearch {
  simulation::SubjectModel subject;
  std::vector<SwapCandidate> candidates;
  double threshold = 0.0;
};

/// Adds label swaps one at a time. Each step tries every pair of labels that is not swapped yet on
/// a coarse grid of noise and lapse, fits the two best, and takes the better one if its gain
/// exceeds the threshold. The odds for a swap are then 20 to 1 even if, beforehand, a swap of some
/// pair was only as likely as none.
/// \param subject  start of the search; its swaps are dropped if swaps are free
[[nodiscard]] SwapSearch search_swaps(const AnswerModel& model, const FitEvidence& evidence,
                                      simulation::SubjectModel subject, const FreeParameters& free);

}  // namespace touchtrial::planning
