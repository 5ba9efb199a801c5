/// \file What each participant's hand felt in each trial, from the traces.
/// Source: docs/method.md, "Felt features".
#pragma once

#include "analysis/cues/trace_reader.hpp"
#include "analysis/outcomes.hpp"
#include "core/plane_geometry.hpp"
#include "engine/perception/felt_features.hpp"
#include "protocols/design/study_key.hpp"
#include "protocols/store/study_store.hpp"

#include <span>
#include <vector>

namespace touchtrial::analysis {

/// Of each trial in a list the features; nothing where the trial has no trace.
struct FeltTrials {
  std::vector<engine::FeltFeatures> felt;
  std::vector<bool> has_trace;
};

/// The counted trials, in their order.
[[nodiscard]] std::vector<const TrialOutcome*> counted_trials(const Outcomes& outcomes);

/// Feels every trial's trace as a hand would that moved so and was pushed so; a trial's several
/// explorations as one. The result does not depend on the number of threads.
/// \param plane  for telling its parts; traces are in its coordinates
/// \param jobs  threads; 0: as many as there are
/// \throws VerificationError, naming the first trial, if a trace does not open
[[nodiscard]] FeltTrials feel_traces(const store::StudyStore& store, const design::StudyKey& key,
                                     std::span<const TrialOutcome* const> trials,
                                     const PlaneGeometry& plane, int jobs = 0,
                                     const TraceProgress& progress = {});

/// A plane from its corner to the farthest that any hand had contact, for when its size is not
/// known. Reads all traces; never empty.
[[nodiscard]] PlaneGeometry touched_plane(const store::StudyStore& store,
                                          const design::StudyKey& key,
                                          std::span<const TrialOutcome* const> trials,
                                          double pitch_mm, int jobs = 0);

}  // namespace touchtrial::analysis
