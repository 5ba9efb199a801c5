/// \file A pool of simulated participants with their thresholds, from which studies of any size are
/// drawn. Source: docs/planning.md, "Power of threshold studies".
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

/// Participants who completed a session with a given number of trials per track.
struct ThresholdPool {
  int trials = 0;                      ///< per track
  std::vector<std::string> standards;  ///< words_of each standard
  /// Thresholds by participant and standard, as the report computes them.
  std::vector<std::vector<analysis::Bounds>> people;
  int unfinished = 0;  ///< participants with an incomplete session; not in `people`
  int tracks = 0;      ///< number of tracks of all `people`
  int below = 0;       ///< thresholds below the lowest level
  int above = 0;       ///< thresholds above the highest level
  int undetermined = 0;
};

struct ThresholdPoolOptions {
  int people = 100;        ///< >= 2
  std::uint64_t seed = 1;  ///< of the participants, as in `simulate --seed`
  int jobs = 1;            ///< number of threads; does not affect results
};

/// Simulates the sessions of a pool, without the control block after the tracks, and computes
/// thresholds as `report` does. Participant n is the same person for every number of trials.
/// \param trials  trials per track; replaces the study's number
/// \param progress  called after each participant, from one thread at a time
/// \throws UsageError if the procedure does not permit this number of trials, or the question gives
///   no thresholds
[[nodiscard]] ThresholdPool simulated_thresholds(const study::StudyKey& key,
                                                 const session::StimulusSource& source,
                                                 const simulation::SubjectModel& subject,
                                                 int trials, const ThresholdPoolOptions& options,
                                                 const study::Progress& progress = {});

}  // namespace touchtrial::planning::threshold
