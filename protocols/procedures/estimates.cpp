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
  int last = 0;
  for (std::size_t i = 1; i < trials.size(); ++i) {
    const std::size_t before = trials[i - 1].level;
    const int turn = trials[i].level > before ? 1 : trials[i].level < before ? -1 : 0;
    if (turn == 0) continue;
    if (last != 0 && turn != last) reversals.push_back(before);
    last = turn;
  }
  return reversals;
}

Threshold reversal_threshold(std::span<const double> levels, std::span<const TrackTrial> trials,
                             std::size_t skipped) {
  if (trials.empty() || levels.empty()) {
    throw std::invalid_argument("reversal_threshold: needs trials and levels");
  }
  std::vector<std::size_t> reversals = reversals_of(trials);
  Threshold found;
  if (reversals.empty()) {
    found.censored = side_of(trials.back().level, levels.size());
    return found;
  }
  reversals.erase(reversals.begin(), reversals.begin() + static_cast<std::ptrdiff_t>(
                                                             std::min(skipped, reversals.size())));
  if (reversals.size() % 2 == 1) reversals.erase(reversals.begin());
  double sum = 0.0;
  for (const std::size_t level : reversals) {
    sum += levels[level];
    if (found.censored == Censored::no) found.censored = side_of(level, levels.size());
  }
  if (found.censored == Censored::no && !reversals.empty()) {
    found.level = sum / static_cast<double>(reversals.size());
  }
  return found;
}

}  // namespace touchtrial::procedures
