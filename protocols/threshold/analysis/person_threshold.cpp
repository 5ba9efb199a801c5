#include "protocols/threshold/analysis/person_threshold.hpp"

namespace touchtrial::analysis::threshold {
namespace {

using procedures::Censored;

Censored side_of(const Bounds& bounds, std::span<const double> levels) {
  if (bounds.exact()) return Censored::no;
  if (bounds.low >= levels.back()) return Censored::above;
  return bounds.high <= levels.front() ? Censored::below : Censored::undetermined;
}

}  // namespace

Bounds bounds_of(const procedures::ThresholdEstimate& track, std::span<const double> levels) {
  if (const std::optional<double> level = track.threshold.level) return {*level, *level};
  const double likely = track.observer.threshold;
  if (likely > levels.back()) return {.low = levels.back()};
  if (likely < levels.front()) return {.high = levels.front()};
  return track.attentive.low || track.attentive.high ? Bounds{likely, likely} : Bounds{};
}

PersonThreshold person_threshold(std::span<const procedures::ThresholdEstimate> tracks,
                                 std::span<const double> levels) {
  Bounds sum{0.0, 0.0};
  for (const procedures::ThresholdEstimate& track : tracks) {
    const Bounds own = bounds_of(track, levels);
    sum.low += own.low;
    sum.high += own.high;
  }
  const auto n = static_cast<double>(tracks.size());
  const Bounds mean{sum.low / n, sum.high / n};
  return {mean, side_of(mean, levels)};
}

std::vector<Bounds> bounds_of(std::span<const PersonThreshold> people) {
  std::vector<Bounds> bounds;
  for (const PersonThreshold& one : people) bounds.push_back(one.bounds);
  return bounds;
}

}  // namespace touchtrial::analysis::threshold
