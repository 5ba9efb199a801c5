#include "protocols/threshold/analysis/person_threshold.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::analysis::threshold {
namespace {

using procedures::Censored;

Censored common_state(std::span<const procedures::ThresholdEstimate> tracks) {
  const Censored first = tracks.front().threshold.censored;
  const bool are_equal = std::ranges::all_of(
      tracks, [first](const auto& track) { return track.threshold.censored == first; });
  return are_equal ? first : Censored::undetermined;
}

}  // namespace

Bounds bounds_of(const procedures::ThresholdEstimate& track, std::span<const double> levels) {
  if (const std::optional<double> level = track.threshold.level) return {*level, *level};
  const double likeliest = track.observer.threshold;
  if (likeliest > levels.back()) return {.low = levels.back()};
  if (likeliest < levels.front()) return {.high = levels.front()};
  return track.attentive.low || track.attentive.high ? Bounds{likeliest, likeliest} : Bounds{};
}

PersonThreshold person_threshold(std::span<const procedures::ThresholdEstimate> tracks,
                                 std::span<const double> levels) {
  Bounds sum{0.0, 0.0};
  for (const procedures::ThresholdEstimate& track : tracks) {
    const Bounds bounds = bounds_of(track, levels);
    sum.low += bounds.low;
    sum.high += bounds.high;
  }
  const auto n = static_cast<double>(tracks.size());
  return {{sum.low / n, sum.high / n}, common_state(tracks)};
}

PersonThreshold difference_of(const PersonThreshold& first,
                              const PersonThreshold& second) noexcept {
  using enum Censored;
  const Bounds bounds = difference_of(first.bounds, second.bounds);
  if (first.censored == no && second.censored == no) return {bounds, no};
  if (first.censored == undetermined || second.censored == undetermined) {
    return {bounds, undetermined};
  }
  if (std::isfinite(bounds.low)) return {bounds, above};
  return {bounds, std::isfinite(bounds.high) ? below : undetermined};
}

std::vector<Bounds> bounds_of(std::span<const PersonThreshold> people) {
  std::vector<Bounds> bounds;
  for (const PersonThreshold& threshold : people) bounds.push_back(threshold.bounds);
  return bounds;
}

CensoredMean mean_of(std::span<const PersonThreshold> people, double level) {
  const CensoredMean mean = censored_mean(bounds_of(people), level);
  const auto undetermined =
      std::ranges::count(people, Censored::undetermined, &PersonThreshold::censored);
  if (2 * static_cast<std::size_t>(undetermined) <= people.size()) return mean;
  return {.participants = mean.participants,
          .exact = mean.exact,
          .open = mean.open,
          .lack = MissingReason::most};
}

std::optional<double> p_of(std::span<const PersonThreshold> people, double null, Sides sides) {
  if (mean_of(people).lack == MissingReason::most) return std::nullopt;
  return censored_p(bounds_of(people), null, sides);
}

}  // namespace touchtrial::analysis::threshold
