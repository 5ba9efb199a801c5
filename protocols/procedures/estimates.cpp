#include "protocols/procedures/estimates.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace touchtrial::procedures {
namespace {

Censored side_of(std::size_t level, std::size_t levels) {
  if (level == 0) return Censored::below;
  return level + 1 == levels ? Censored::above : Censored::no;
}

}  // namespace

std::vector<std::size_t> reversals_of(std::span<const TrackTrial> trials) {
  std::vector<std::size_t> reversals;
  int last_direction = 0;
  for (std::size_t i = 1; i < trials.size(); ++i) {
    const std::size_t previous = trials[i - 1].level;
    const int direction = trials[i].level > previous ? 1 : trials[i].level < previous ? -1 : 0;
    if (direction == 0) continue;
    if (last_direction != 0 && direction != last_direction) reversals.push_back(previous);
    last_direction = direction;
  }
  return reversals;
}

Threshold reversal_threshold(std::span<const double> levels, std::span<const TrackTrial> trials,
                             std::size_t skipped) {
  if (trials.empty() || levels.empty()) {
    throw std::invalid_argument("reversal_threshold: needs trials and levels");
  }
  std::vector<std::size_t> reversals = reversals_of(trials);
  Threshold threshold;
  if (reversals.empty()) {
    threshold.censored = side_of(trials.back().level, levels.size());
    return threshold;
  }
  reversals.erase(reversals.begin(), reversals.begin() + static_cast<std::ptrdiff_t>(
                                                             std::min(skipped, reversals.size())));
  if (reversals.size() % 2 == 1) reversals.erase(reversals.begin());
  double sum = 0.0;
  for (const std::size_t level : reversals) {
    sum += levels[level];
    if (threshold.censored == Censored::no) threshold.censored = side_of(level, levels.size());
  }
  if (threshold.censored == Censored::no && !reversals.empty()) {
    threshold.level = sum / static_cast<double>(reversals.size());
  }
  return threshold;
}

}  // namespace touchtrial::procedures
