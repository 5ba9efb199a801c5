/// \file A pool of simulated participants with their ratings, from which studies of any size are
/// drawn. Source: docs/planning.md, "Power of rating studies".
#pragma once

#include "analysis/planning/pool_sessions.hpp"
#include "analysis/statistics/proportion.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "study/prepare.hpp"
#include "study/study_key.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::planning::rating {

/// Indices of the study's two compared methods.
struct MethodPair {
  int first = 0;
  int second = 1;
};

/// One participant's mean ratings on one scale. As in `report`, each texture has the same weight,
/// and a mean is missing if a texture was never rated.
struct PooledRating {
  std::optional<double> first;       ///< mean with the first method
  std::optional<double> second;      ///< mean with the second method
  std::optional<double> difference;  ///< first minus second

  friend bool operator==(const PooledRating&, const PooledRating&) = default;
};

/// The ratings on one scale, in its units.
struct PooledScale {
  std::string id;
  analysis::Interval ends;
  std::vector<PooledRating> people;  ///< same people in the same order on every scale
};

/// Participants who completed all sessions of the study.
struct RatingPool {
  std::vector<PooledScale> scales;  ///< of the study
  int people = 0;
  int unfinished = 0;  ///< participants with an incomplete session; not counted in `people`
};

struct RatingPoolOptions {
  int people = 100;        ///< >= 2
  std::uint64_t seed = 1;  ///< of the participants, as in `simulate --seed`
  int jobs = 1;            ///< number of threads; does not affect results
};

/// Simulates the sessions of a pool.
/// \param pair  two different methods of the study
/// \param progress  called after each participant, from one thread at a time
[[nodiscard]] RatingPool simulated_ratings(const study::StudyKey& key,
                                           const session::StimulusSource& source,
                                           const simulation::SubjectModel& subject,
                                           const MethodPair& pair, const RatingPoolOptions& options,
                                           const study::Progress& progress = {});

}  // namespace touchtrial::planning::rating
