/// \file Traces of many trials, one after another, opened on all threads.
#pragma once

#include "analysis/outcomes.hpp"
#include "protocols/design/study_key.hpp"
#include "protocols/store/study_store.hpp"

#include <functional>
#include <span>
#include <vector>

namespace touchtrial::analysis {

/// What is done with one trace. \param place  of its trial in the list of trials
using TraceVisitor = std::function<void(std::size_t place, const store::Trace& trace)>;

/// Told now and then how many traces are done, on the calling thread; may be empty.
using TraceProgress = std::function<void(int done, int of)>;

/// Reads each trial's trace on the calling thread, a few dozen at a time, and opens and visits
/// those of one batch on several threads, in no order; the visitor may write to what belongs to its
/// place alone. At most 64 sealed traces, and one open trace a thread, are in memory. \param jobs
/// threads, >= 1; 0: as many as there are \return the places of trials that have no trace \throws
/// VerificationError, naming the first trial, if a trace does not open
std::vector<std::size_t> visit_traces(const store::StudyStore& store, const design::StudyKey& key,
                                      std::span<const TrialOutcome* const> trials, int jobs,
                                      const TraceVisitor& visit,
                                      const TraceProgress& progress = {});

}  // namespace touchtrial::analysis
