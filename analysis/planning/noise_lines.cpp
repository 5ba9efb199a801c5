#include "analysis/planning/noise_lines.hpp"

#include <cstddef>
#include <limits>

namespace touchtrial::planning {
namespace {

/// The largest for much negative noise: the one that falls the least, or rises the most backwards.
std::size_t first_winner(std::span<const double> at, std::span<const double> slope) noexcept {
  std::size_t best = 0;
  for (std::size_t k = 1; k < at.size(); ++k) {
    const bool sooner = slope[k] < slope[best];
    if (sooner || (slope[k] == slope[best] && at[k] > at[best])) best = k;
  }
  return best;
}

struct Crossing {
  std::size_t winner = 0;
  double t = std::numeric_limits<double>::infinity();
};

/// Where the next one overtakes.
Crossing next_winner(std::span<const double> at, std::span<const double> slope,
                     std::size_t winner) noexcept {
  Crossing next{winner};
  for (std::size_t k = 0; k < at.size(); ++k) {
    const double gain = slope[k] - slope[winner];
    if (!(gain > 0.0)) continue;
    const double t = (at[winner] - at[k]) / gain;
    if (t < next.t || (t == next.t && slope[k] > slope[next.winner])) next = {k, t};
  }
  return next;
}

/// Shares a probability among the pictures of all prototypes that are as strong everywhere.
void share(std::span<const double> at, std::span<const double> slope, std::span<const int> picture,
           std::size_t winner, double probability, std::span<double> answers) noexcept {
  const auto stands_for_its_picture = [&](std::size_t k) {
    if (at[k] != at[winner] || slope[k] != slope[winner]) return false;
    for (std::size_t before = 0; before < k; ++before) {
      const bool equal = at[before] == at[winner] && slope[before] == slope[winner];
      if (equal && picture[before] == picture[k]) return false;
    }
    return true;
  };
  int equals = 0;
  for (std::size_t k = 0; k < at.size(); ++k) equals += stands_for_its_picture(k) ? 1 : 0;
  for (std::size_t k = 0; k < at.size(); ++k) {
    if (stands_for_its_picture(k)) answers[picture[k]] += probability / equals;
  }
}

/// Whether another prototype's picture is as strong everywhere: stimuli that feel the same.
bool has_equal(std::span<const double> at, std::span<const double> slope,
               std::size_t winner) noexcept {
  bool equal = false;
  for (std::size_t k = 0; k < at.size(); ++k) {
    equal |= k != winner && slope[k] == slope[winner] && at[k] == at[winner];
  }
  return equal;
}

}  // namespace

void add_winners(std::span<const double> at, std::span<const double> slope,
                 std::span<const int> picture, const RadialDistribution& noise, double weight,
                 std::span<double> answers, std::span<double> slopes) noexcept {
  std::size_t winner = first_winner(at, slope);
  double below = 0.0;
  for (;;) {
    const Crossing next = next_winner(at, slope, winner);
    const RadialDistribution::Value value = noise.at(next.t);
    const double probability = weight * (value.below - below);
    if (has_equal(at, slope, winner)) {
      share(at, slope, picture, winner, probability, answers);
    } else {
      answers[picture[winner]] += probability;
    }
    if (next.winner == winner) return;
    if (!slopes.empty() && value.density > 0.0) {
      const double rate = weight * value.density / (slope[next.winner] - slope[winner]);
      const auto from = static_cast<std::size_t>(picture[winner]);
      const auto to = static_cast<std::size_t>(picture[next.winner]);
      const std::size_t pictures = answers.size();
      slopes[from * pictures + from] += rate;
      slopes[from * pictures + to] -= rate;
      slopes[to * pictures + from] -= rate;
      slopes[to * pictures + to] += rate;
    }
    below = value.below;
    winner = next.winner;
  }
}

}  // namespace touchtrial::planning
