/// \file Replays answers through the procedure of one track: its levels and posteriors. Source:
/// docs/thresholds.md, "The command".
#pragma once

#include "protocols/procedures/posterior.hpp"
#include "protocols/procedures/procedure.hpp"
#include "study/study.hpp"

#include <string>
#include <vector>

namespace touchtrial::planning::threshold {

/// Summary of the posterior of one parameter. `mode` is its value at the most probable grid point.
struct Belief {
  double mean = 0.0;
  double sd = 0.0;
  double mode = 0.0;
};

/// Summary of the posterior of an observer.
struct ObserverBelief {
  Belief threshold;
  Belief slope;
  Belief lapse;
};

/// One track with the given answers.
struct TrackWalk {
  int track = 1;      ///< from 1
  std::string words;  ///< the standard of the track, in words
  std::string unit;   ///< of a level
  procedures::TrackSettings settings;
  std::vector<bool> answers;  ///< whether each was right
  /// The level of each answer and, if trials remain, of the next one.
  std::vector<double> levels;
  /// Posteriors before the first answer and after each. Empty if answers have no fixed guess rate.
  std::vector<ObserverBelief> posteriors;
  /// Priors of threshold, slope and lapse, whose product is the prior of a grid point. Empty if
  /// `posteriors` is.
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
