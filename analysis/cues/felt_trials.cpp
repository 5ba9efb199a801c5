#include "analysis/cues/felt_trials.hpp"

#include "core/vec.hpp"
#include "engine/perception/texture_sense.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::analysis {
namespace {

engine::FeltFeatures felt_in(const store::Trace& trace, const PlaneGeometry& plane) {
  engine::TextureSense sense({.rate_hz = trace.rate_hz, .plane = plane});
  for (const store::TraceSample& sample : trace.samples)
    sense.feel(sample.position_mm, sample.force_n);
  return sense.features();
}

Vec2 farthest_contact_mm(const store::Trace& trace) {
  Vec2 farthest_mm;
  for (const store::TraceSample& sample : trace.samples) {
    if (sample.force_n.z <= 0.0) continue;
    farthest_mm.x = std::max(farthest_mm.x, sample.position_mm.x);
    farthest_mm.y = std::max(farthest_mm.y, sample.position_mm.y);
  }
  return farthest_mm;
}

}  // namespace

std::vector<const TrialOutcome*> counted_trials(const Outcomes& outcomes) {
  std::vector<const TrialOutcome*> trials;
  for (const TrialOutcome& trial : outcomes.trials) {
    if (trial.counted) trials.push_back(&trial);
  }
  return trials;
}

FeltTrials feel_traces(const store::StudyStore& store, const design::StudyKey& key,
                       std::span<const TrialOutcome* const> trials, const PlaneGeometry& plane,
                       int jobs, const TraceProgress& progress) {
  FeltTrials all;
  all.felt.resize(trials.size());
  all.has_trace.resize(trials.size(), true);
  const auto feel = [&](std::size_t place, const store::Trace& trace) {
    all.felt[place] = felt_in(trace, plane);
  };
  for (const std::size_t place : visit_traces(store, key, trials, jobs, feel, progress)) {
    all.has_trace[place] = false;
  }
  return all;
}

PlaneGeometry touched_plane(const store::StudyStore& store, const design::StudyKey& key,
                            std::span<const TrialOutcome* const> trials, double pitch_mm,
                            int jobs) {
  std::vector<Vec2> farthest_mm(trials.size());
  static_cast<void>(
      visit_traces(store, key, trials, jobs, [&](std::size_t place, const store::Trace& trace) {
        farthest_mm[place] = farthest_contact_mm(trace);
      }));
  PlaneGeometry plane{pitch_mm, 1, 1};
  for (const Vec2& reached_mm : farthest_mm) {
    plane.width_px = std::max(plane.width_px, static_cast<int>(std::ceil(reached_mm.x / pitch_mm)));
    plane.height_px =
        std::max(plane.height_px, static_cast<int>(std::ceil(reached_mm.y / pitch_mm)));
  }
  return plane;
}

}  // namespace touchtrial::analysis
