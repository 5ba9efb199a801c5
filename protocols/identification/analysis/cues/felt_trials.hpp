/// \file Opens the traces of many trials and computes their felt features; finds the size of the
/// plane from the study's files. Source: docs/method.md, "Felt features".
#pragma once

#include "analysis/outcomes/outcomes.hpp"
#include "core/plane_geometry.hpp"
#include "engine/pack/pack.hpp"
#include "engine/perception/felt_features.hpp"
#include "record/study_store.hpp"
#include "study/study_key.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::analysis::identification {

/// \param place  index of the trace's trial in the list of trials
using TraceVisitor = std::function<void(std::size_t place, const record::Trace& trace)>;

/// Called occasionally on the calling thread; may be empty.
using TraceProgress = std::function<void(int done, int total)>;

/// Reads the trials' traces in batches on the calling thread. Opens and visits the traces of a
/// batch on several threads, in any order; the visitor may write only to data of its place. No more
/// than 64 sealed traces and one open trace per thread are in memory.
/// \param jobs  threads, >= 1; 0: one for each core
/// \return the places of trials that have no trace
/// \throws VerificationError, naming the first trial, if a trace does not open
std::vector<std::size_t> visit_traces(const record::StudyStore& store, const study::StudyKey& key,
                                      std::span<const TrialOutcome* const> trials, int jobs,
                                      const TraceVisitor& visit,
                                      const TraceProgress& progress = {});

/// The felt features of trials, in their order.
struct FeltTrials {
  std::vector<engine::FeltFeatures> features;
  std::vector<bool> has_trace;  ///< features are meaningless without a trace
};

/// Computes the felt features of every trial from its trace. All explorations of a trial count as
/// one. The result does not depend on the number of threads.
/// \param plane  the plane of the traces' coordinates
/// \param jobs  threads; 0: one for each core
/// \throws VerificationError, naming the first trial, if a trace does not open
[[nodiscard]] FeltTrials feel_traces(const record::StudyStore& store, const study::StudyKey& key,
                                     std::span<const TrialOutcome* const> trials,
                                     const PlaneGeometry& plane, int jobs = 0,
                                     const TraceProgress& progress = {});

/// A plane from the corner to the farthest contact of any hand, for planes of unknown size. Reads
/// all traces; never empty.
[[nodiscard]] PlaneGeometry touched_plane(const record::StudyStore& store,
                                          const study::StudyKey& key,
                                          std::span<const TrialOutcome* const> trials,
                                          double pitch_mm, int jobs = 0);

struct StudyPlane {
  PlaneGeometry geometry;
  std::string source;  ///< "the study's pack"
};

/// The part of the plane that all stimuli share. The size is from the pack's headers, otherwise
/// from the study's images.
/// \return nothing if neither can be read
[[nodiscard]] std::optional<StudyPlane> study_plane(const study::StudyKey& key,
                                                    const std::optional<engine::Pack>& pack);

}  // namespace touchtrial::analysis::identification
