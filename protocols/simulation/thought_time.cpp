#include "protocols/simulation/thought_time.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace touchtrial::simulation {

double margin_of(std::span<const double> support) {
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  double max = kNone;
  double second = kNone;
  for (const double value : support) {
    second = std::max(second, std::min(value, max));
    max = std::max(max, value);
  }
  return second == kNone ? std::numeric_limits<double>::infinity() : max - second;
}

double thought_time_s(const ThoughtTime& thought, double margin, RandomStream& random) {
  const double surplus_s = (thought.hard_s - thought.easy_s) * std::exp(-margin / thought.margin);
  const double above_s = (thought.easy_s + surplus_s) * std::exp(thought.spread * random.normal());
  return std::min(thought.shift_s + above_s, thought.max_s);
}

}  // namespace touchtrial::simulation
