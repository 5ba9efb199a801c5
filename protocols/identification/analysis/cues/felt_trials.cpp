#include "protocols/identification/analysis/cues/felt_trials.hpp"

#include "analysis/outcomes/sealed_sessions.hpp"
#include "core/errors.hpp"
#include "core/parallel.hpp"
#include "core/vec.hpp"
#include "engine/image_file.hpp"
#include "engine/perception/texture_sense.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

constexpr std::size_t kBatchSize = 64;

struct PendingTrace {
  std::size_t place = 0;
  const record::TrialRow* row = nullptr;
  const SecretKey* key = nullptr;
  record::SealedTrace sealed;
  std::string error;  ///< empty if it opened
};

std::string trace_message(const record::TrialRow& row, const std::string& error) {
  return fmt::format(
      "session {}, trial {}: the trace {}; run `touchtrial verify` and restore the "
      "database from a backup",
      row.session, row.trial, error);
}

/// Stores an error instead of throwing it, so that the error of the first trial is reported,
/// regardless of the order of threads.
void open_and_visit(PendingTrace& pending, const TraceVisitor& visit) {
  try {
    const std::optional<record::Trace> trace = record::unsealed_trace(pending.sealed, *pending.key);
    if (trace) {
      visit(pending.place, *trace);
    } else {
      pending.error = "does not open";
    }
  } catch (const StoreError& error) {
    pending.error = fmt::format("does not decode ({})", error.what());
  }
}

void visit_batch(std::vector<PendingTrace>& batch, int jobs, const TraceVisitor& visit) {
  in_parallel(jobs, batch.size(), [&](std::size_t i) { open_and_visit(batch[i], visit); });
  for (const PendingTrace& pending : batch) {
    if (!pending.error.empty()) throw VerificationError(trace_message(*pending.row, pending.error));
  }
  batch.clear();
}

engine::FeltFeatures features_of(const record::Trace& trace, const PlaneGeometry& plane) {
  engine::TextureSense sense({.rate_hz = trace.rate_hz, .plane = plane});
  for (const record::TraceSample& sample : trace.samples)
    sense.feel(sample.position_mm, sample.force_n);
  return sense.features();
}

Vec2 farthest_contact_mm(const record::Trace& trace) {
  Vec2 farthest_mm;
  for (const record::TraceSample& sample : trace.samples) {
    if (sample.force_n.z <= 0.0) continue;
    farthest_mm.x = std::max(farthest_mm.x, sample.position_mm.x);
    farthest_mm.y = std::max(farthest_mm.y, sample.position_mm.y);
  }
  return farthest_mm;
}

/// Reduces `common` to the part that both planes share; an empty `common` becomes `other`.
void keep_common(PlaneGeometry& common, const PlaneGeometry& other) {
  const bool is_empty = common.height_px == 0;
  common.pitch_mm = is_empty ? other.pitch_mm : common.pitch_mm;
  common.height_px = is_empty ? other.height_px : std::min(common.height_px, other.height_px);
  common.width_px = is_empty ? other.width_px : std::min(common.width_px, other.width_px);
}

PlaneGeometry plane_of_pack(const engine::Pack& pack) {
  PlaneGeometry common;
  for (const engine::PackEntry& entry : pack.manifest().entries) {
    keep_common(common, pack.map(entry.code).view().geometry);
  }
  return common;
}

PlaneGeometry plane_of_images(const study::Study& study) {
  PlaneGeometry common;
  for (const study::StudyClass& texture : study.classes) {
    for (const auto& image : texture.images) {
      const GreyImage picture = engine::read_grey_image(study.folder / image);
      keep_common(common, {study.rendering.pitch_mm, picture.height(), picture.width()});
    }
  }
  return common;
}

template <typename Make>
std::optional<StudyPlane> if_readable(const char* source, Make make) {
  try {
    const PlaneGeometry geometry = make();
    if (geometry.height_px > 0) return StudyPlane{geometry, source};
  } catch (const FileError&) {
    // The caller tries another source.
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::size_t> visit_traces(const record::StudyStore& store, const study::StudyKey& key,
                                      std::span<const TrialOutcome* const> trials, int jobs,
                                      const TraceVisitor& visit, const TraceProgress& progress) {
  const SessionKeys keys = person_keys(store, key);
  std::vector<std::size_t> missing;
  std::vector<PendingTrace> batch;
  for (std::size_t place = 0; place < trials.size(); ++place) {
    const record::TrialRow& row = trials[place]->row;
    std::optional<record::SealedTrace> sealed = store.sealed_trace(row.session, row.trial);
    const auto person = keys.find(row.session);
    if (!sealed || person == keys.end() || !person->second.participant) {
      missing.push_back(place);
      continue;
    }
    batch.push_back({place, &row, &*person->second.participant, *std::move(sealed), {}});
    if (batch.size() < kBatchSize) continue;
    visit_batch(batch, jobs, visit);
    if (progress) progress(static_cast<int>(place), static_cast<int>(trials.size()));
  }
  visit_batch(batch, jobs, visit);
  if (progress) progress(static_cast<int>(trials.size()), static_cast<int>(trials.size()));
  return missing;
}

FeltTrials feel_traces(const record::StudyStore& store, const study::StudyKey& key,
                       std::span<const TrialOutcome* const> trials, const PlaneGeometry& plane,
                       int jobs, const TraceProgress& progress) {
  FeltTrials all;
  all.features.resize(trials.size());
  all.has_trace.resize(trials.size(), true);
  const auto feel = [&](std::size_t place, const record::Trace& trace) {
    all.features[place] = features_of(trace, plane);
  };
  for (const std::size_t place : visit_traces(store, key, trials, jobs, feel, progress)) {
    all.has_trace[place] = false;
  }
  return all;
}

PlaneGeometry touched_plane(const record::StudyStore& store, const study::StudyKey& key,
                            std::span<const TrialOutcome* const> trials, double pitch_mm,
                            int jobs) {
  std::vector<Vec2> farthest_mm(trials.size());
  static_cast<void>(
      visit_traces(store, key, trials, jobs, [&](std::size_t place, const record::Trace& trace) {
        farthest_mm[place] = farthest_contact_mm(trace);
      }));
  PlaneGeometry plane{pitch_mm, 1, 1};
  for (const Vec2& contact_mm : farthest_mm) {
    plane.width_px = std::max(plane.width_px, static_cast<int>(std::ceil(contact_mm.x / pitch_mm)));
    plane.height_px =
        std::max(plane.height_px, static_cast<int>(std::ceil(contact_mm.y / pitch_mm)));
  }
  return plane;
}

std::optional<StudyPlane> study_plane(const study::StudyKey& key,
                                      const std::optional<engine::Pack>& pack) {
  if (pack) {
    if (auto plane = if_readable("the study's pack", [&] { return plane_of_pack(*pack); })) {
      return plane;
    }
  }
  return if_readable("the study's images", [&] { return plane_of_images(key.study); });
}

}  // namespace touchtrial::analysis::identification
