/// \file Replays answers through the procedure of one track to show its levels and posteriors.
/// Source: docs/thresholds.md, "The command".
#pragma once

#include "protocols/procedures/posterior.hpp"
#include "protocols/procedures/procedure.hpp"
#include "study/study.hpp"

#include <string>
#include <vector>

namespace touchtrial::planning::threshold {

/// Summary of one parameter's posterior.
struct ParameterSummary {
  double mean = 0.0;
  double sd = 0.0;
  double mode = 0.0;  ///< value at the most probable grid point
};

/// Summary of the posterior of an observer's parameters.
struct ObserverSummary {
  ParameterSummary threshold;
  ParameterSummary slope;
  ParameterSummary lapse;
};

/// One track, replayed with a list of answers.
struct TrackWalk {
  int track = 1;      ///< from 1
  std::string words;  ///< words_of the track's standard
  std::string unit;   ///< of levels
  procedures::TrackSettings settings;
  std::vector<bool> answers;  ///< true: right
  /// The level of each answer and, if trials remain, of the next trial.
  std::vector<double> levels;
  /// Posteriors before the first answer and after each answer. Empty if the question has no fixed
  /// guess rate.
  std::vector<ObserverSummary> posteriors;
  /// Priors of threshold, slope and lapse; their product is the prior of a grid point. Empty if
  /// `posteriors` is empty.
  std::vector<procedures::Marginal> prior;
};

/// Replays answers through a track of a study.
/// \param track  from 1
/// \pre the study's protocol is threshold
/// \throws UsageError if the track does not exist, or there are more answers than trials
[[nodiscard]] TrackWalk replay_track(const study::Study& study, int track,
                                     const std::vector<bool>& answers);

[[nodiscard]] std::string track_walk_json(const TrackWalk& walk);

}  // namespace touchtrial::planning::threshold
