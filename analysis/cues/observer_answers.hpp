/// \file All observers' answers to one method's trials, as sure as they can be and as unsure as the
/// participants were. Source: docs/cues.md.
#pragma once

#include "analysis/cues/ideal_observer.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace touchtrial::analysis {

/// One observer's answers by trial; empty shares where a trial cannot be judged.
struct ObserverAnswers {
  std::vector<AnswerShares> ideal;
  double matched_noise = 0.0;  ///< 0: the ideal answers are right no more often than people's
  std::vector<AnswerShares> matched;  ///< with that noise
};

/// The noise is found by bisection on the share of right answers, within 1e-3 of it, on at most
/// 2,000 of the trials with a response, evenly chosen.
/// \param responses  by trial; nothing: no response
/// \param jobs  threads, on which the result does not depend; 0: as many as there are
/// \throws std::invalid_argument as Observer, or if there are not as many responses as trials
[[nodiscard]] ObserverAnswers observer_answers(Cue cue, std::span<const ObservedTrial> trials,
                                               std::span<const std::optional<int>> responses,
                                               int classes, int jobs = 0);

}  // namespace touchtrial::analysis
