/// \file Efficiencies and divergences of one method, with intervals over participants.
/// Source: docs/cues.md; docs/statistics.md, "Participants as clusters".
#pragma once

#include "analysis/cues/cue_report.hpp"
#include "analysis/cues/participant_answers.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace touchtrial::analysis {

/// Figures of the observers, in the order of kCues.
struct CueStatistics {
  std::array<CueFigure, kCues.size()> efficiency;
  std::array<CueFigure, kCues.size()> corrected;
  std::array<CueFigure, kCues.size()> divergence;
  std::array<CueFigure, kCues.size()> matched_divergence;
  std::optional<CueMatch> match;
};

/// Every figure's interval is expanded_percentiles (95 %) of 9,999 draws of whole participants
/// with replacement, the same draws for all; a figure that a draw leaves undefined (an observer at
/// or below chance, for what is corrected) has none.
/// \param participants  of the same number of classes, each with a trial
/// \param index  chooses the stream of random numbers
/// \param jobs  threads, on which the result does not depend; 0: as many as there are
[[nodiscard]] CueStatistics cue_statistics(std::span<const ParticipantAnswers> participants,
                                           std::uint64_t index, int jobs = 0);

}  // namespace touchtrial::analysis
