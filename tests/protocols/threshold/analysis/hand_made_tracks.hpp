/// \file Outcomes of a threshold study for which a test gives every trial, or the observer who
/// answers.
#pragma once

#include "analysis/outcomes/outcomes.hpp"
#include "core/random.hpp"
#include "protocols/procedures/psychometric_function.hpp"
#include "protocols/threshold/study/threshold.hpp"

#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial {

/// From `low` to `high`, in steps.
[[nodiscard]] std::vector<double> levels_from(double low, double high, double step);

/// Detection in two intervals with QUEST+: levels of -40 to 0 dB.
[[nodiscard]] study::threshold::ThresholdOptions detection_options();
/// Discrimination of gains with constant stimuli, about these standards in dB.
[[nodiscard]] study::threshold::ThresholdOptions constant_options(std::vector<double> standards);
/// Same or different along a blend of two textures at three levels.
[[nodiscard]] study::threshold::ThresholdOptions same_different_options();

/// One answered trial.
struct HandMadeAnswer {
  int session = 1;
  int track = 1;  ///< 0: none
  int level = 0;
  int target = 0;
  int response = 0;
  study::Role role = study::Role::scored;
};

/// Sessions are of P1, P2 and so on.
class HandMadeTracks {
 public:
  explicit HandMadeTracks(const study::threshold::ThresholdOptions& options,
                          const std::vector<std::string>& classes = {"bark"});

  void session(bool counted = true);
  void answer(const HandMadeAnswer& of);
  /// A trial of a track in which the time ran out.
  void missed(int session, int track, int level);
  /// The whole track of an observer, whose answers `random` draws.
  void track(int session, int number, const procedures::Observer& observer, RandomStream& random);
  /// The same with six catch trials.
  void attended_track(int session, int number, const procedures::Observer& observer,
                      RandomStream& random);
  /// Catch trials of a track; targets alternate.
  void caught(int session, int track, int right, int wrong);
  /// Trials outside the tracks, at the highest level; targets alternate.
  void outside(int session, study::Role role, int right, int wrong);

  analysis::Outcomes outcomes;

 private:
  [[nodiscard]] const study::threshold::ThresholdOptions& options() const;
};

/// Two intervals, and few lapses.
[[nodiscard]] procedures::Observer observer_at(double threshold);
/// Participants with these thresholds, each with every track of the study.
[[nodiscard]] HandMadeTracks tracks_of(const study::threshold::ThresholdOptions& options,
                                       int tracks, const std::vector<double>& thresholds,
                                       bool with_catches = false);
/// The report's JSON.
[[nodiscard]] nlohmann::json json_of(const HandMadeTracks& made);

}  // namespace touchtrial
