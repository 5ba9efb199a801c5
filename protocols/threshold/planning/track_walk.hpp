/// \file What the procedure of one track chooses after a list of answers, and what it then believes.
/// Source: docs/thresholds.md, "The command".
#pragma once

#include "protocols/procedures/posterior.hpp"
#include "protocols/procedures/procedure.hpp"
#include "study/study.hpp"

#include <string>
#include <vector>

namespace touchtrial::planning::threshold {

/// What is believed of one parameter. `mode` is of the most probable grid point.
struct Belief {
  double mean = 0.0;
  double sd = 0.0;
  double mode = 0.0;
};

struct ObserverBelief {
  Belief threshold;
  Belief slope;
  Belief lapse;
};

/// One track by itself, as far as the answers go.
struct TrackWalk {
  int track = 1;      ///< from 1
  std::string words;  ///< what the track is about
  std::string unit;   ///< of a level
  procedures::TrackSettings settings;
  std::vector<bool> answers;  ///< whether each was right
  /// The level before each answer and, if the track has trials left, the next one.
  std::vector<double> levels;
  /// Before the first answer and after each. Empty if answers have no fixed guess rate.
  std::vector<ObserverBelief> beliefs;
  /// Of threshold, slope and lapse, before the first answer; their product is the prior of a grid
  /// point. Empty as `beliefs` is.
  std::vector<procedures::Marginal> prior;
};

/// \param track  from 1
/// \pre the study's protocol is threshold
/// \throws UsageError if the track is not there, or there are more answers than trials
[[nodiscard]] TrackWalk walked(const study::Study& study, int track,
                               const std::vector<bool>& answers);

[[nodiscard]] std::string track_walk_json(const TrackWalk& walk);

}  // namespace touchtrial::planning::threshold
