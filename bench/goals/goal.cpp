#include "bench/goals/goal.hpp"

#include <cmath>

namespace touchtrial::bench {

double limited_figure(const GoalResult& result) noexcept {
  switch (result.limit) {
    case Limit::time_us:
      return result.ours_us;
    case Limit::error:
      return result.error;
    case Limit::count:
      return result.count;
    case Limit::ratio:
      break;
  }
  return result.ratio;
}

bool has_target(const GoalResult& result) noexcept {
  return !std::isnan(result.target);
}

bool is_met(const GoalResult& result) noexcept {
  return limited_figure(result) <= result.target;
}

}  // namespace touchtrial::bench
