/// \file Thresholds of simulated participants, from which studies of any size are drawn.
/// Source: docs/planning.md, "Power of threshold studies".
#pragma once

#include "analysis/statistics/censored_mean.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "study/prepare.hpp"
#include "study/study_key.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::planning::threshold {

/// Participants who each did a whole session with so many trials a track.
struct ThresholdPool {
  int trials = 0;                      ///< of a track
  std::vector<std::string> standards;  ///< in words
  /// By participant, then standard: as what the report counts the own tracks.
  std::vector<std::vector<analysis::Bounds>> people;
  int unfinished = 0;  ///< participants whose session did not reach its end; not among `people`
  int tracks = 0;      ///< of all `people`
  int below = 0;       ///< thresholds of people beyond the lowest level
  int above = 0;
  int undetermined = 0;
};

struct ThresholdPoolOptions {
  int people = 100;        ///< >= 2
  std::uint64_t seed = 1;  ///< of everything random in participants, as in `simulate --seed`
  int jobs = 1;            ///< threads; results do not depend on them
};

/// Simulates sessions without their control block, which comes after the tracks. The thresholds are
/// those that `report` counts. Participant n is the same person for every number of trials.
/// \param trials  of a track, in place of the study's
/// \param progress  called after each participant, from one thread at a time
/// \throws UsageError if the procedure cannot have so many trials, or the question has no
///   thresholds
[[nodiscard]] ThresholdPool simulated_thresholds(const study::StudyKey& key,
                                                 const session::StimulusSource& source,
                                                 const simulation::SubjectModel& subject,
                                                 int trials, const ThresholdPoolOptions& options,
                                                 const study::Progress& progress = {});

}  // namespace touchtrial::planning::threshold
