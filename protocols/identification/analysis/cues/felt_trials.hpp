/// \file Opens the traces of many trials, and feels them as each participant's hand did.
/// Source: docs/method.md, "Felt features".
#pragma once

#include "analysis/outcomes.hpp"
#include "core/plane_geometry.hpp"
#include "engine/perception/felt_features.hpp"
#include "protocols/design/study_key.hpp"
#include "protocols/store/study_store.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace touchtrial::analysis::identification {

/// Called with one opened trace.
/// \param place  of its trial in the list of trials
using TraceVisitor = std::function<void(std::size_t place, const store::Trace& trace)>;

/// Called from time to time, on the calling thread, with how many traces are done; may be empty.
using TraceProgress = std::function<void(int done, int of)>;

/// Reads the trials' traces on the calling thread in batches, and opens and visits the traces of
/// one batch on several threads, in no particular order. The visitor may write only to what belongs
/// to its place. At most 64 sealed traces, and one open trace for each thread, are in memory.
/// \param jobs  threads, >= 1; 0: one for each core
/// \return the places of trials that have no trace
/// \throws VerificationError, naming the first trial, if a trace does not open
std::vector<std::size_t> visit_traces(const store::StudyStore& store, const design::StudyKey& key,
                                      std::span<const TrialOutcome* const> trials, int jobs,
                                      const TraceVisitor& visit,
                                      const TraceProgress& progress = {});

/// The features of each trial in a list.
struct FeltTrials {
  std::vector<engine::FeltFeatures> felt;
  std::vector<bool> has_trace;  ///< features of a trial without a trace mean nothing
};

/// Feels every trial's trace as a hand with these movements and forces would; the explorations of
/// one trial count as one. The result does not depend on the number of threads.
/// \param plane  whose parts are told apart; traces are in its coordinates
/// \param jobs  threads; 0: one for each core
/// \throws VerificationError, naming the first trial, if a trace does not open
[[nodiscard]] FeltTrials feel_traces(const store::StudyStore& store, const design::StudyKey& key,
                                     std::span<const TrialOutcome* const> trials,
                                     const PlaneGeometry& plane, int jobs = 0,
                                     const TraceProgress& progress = {});

/// A plane from its corner to the farthest contact of any hand, for studies whose plane's size is
/// unknown. Reads all traces; never empty.
[[nodiscard]] PlaneGeometry touched_plane(const store::StudyStore& store,
                                          const design::StudyKey& key,
                                          std::span<const TrialOutcome* const> trials,
                                          double pitch_mm, int jobs = 0);

}  // namespace touchtrial::analysis::identification
