#include "bench/cases/cases.hpp"
#include "bench/goals/goal.hpp"
#include "bench/inputs/pictures.hpp"
#include "bench/measure/pair.hpp"
#include "bench/measure/rows.hpp"
#include "bench/measure/tv_gabor_courses.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

namespace touchtrial::bench {
namespace {

constexpr double kWantedError = 1e-3;
constexpr double kTimeTarget = 0.08;
constexpr double kStepsTarget = 80;
constexpr int kFixedPointSteps = 1000;

/// The time to come close, beside that of the fixed point, which does not come as close.
std::vector<GoalResult> time_to_error(const Effort& effort) {
  GoalResult result;
  result.goal = "TV-Gabor, to 1e-3 of v";
  result.target = kTimeTarget;
  const GreyImage image = square_of(timed_picture(), kUsualSize_px);
  const std::optional<CoursePoint> close = admm_until(image, kWantedError);
  if (!close) return {result};
  const Case peer = fixed_point_case(kUsualSize_px, kFixedPointSteps);
  const PairTimes times = time_pair(admm_case(kUsualSize_px, close->steps), peer, effort);
  result.peer = fmt::format("{}, to {:.0e}", peer.who, error_of(peer));
  result.ours_us = times.ours_us;
  result.peer_us = times.peer_us;
  result.ratio = times.ratio;
  result.error = close->error;
  result.error_unit = "of v";
  return {result};
}

std::vector<GoalResult> most_steps(int pictures) {
  GoalResult result;
  result.goal = "TV-Gabor, most steps to 1e-3 of v";
  result.count = 0.0;
  result.count_unit = "steps";
  result.limit = Limit::count;
  result.target = kStepsTarget;
  for (const Picture& picture : shipped_pictures()) {
    if (picture.has_ground || pictures-- <= 0) break;
    const std::optional<CoursePoint> close = admm_until(picture.image, kWantedError);
    result.count = close ? std::max<double>(result.count, close->steps) : kNotTaken;
    if (!close) break;
  }
  return {result};
}

}  // namespace

std::vector<Goal> tv_gabor_goals() {
  return {[](const Effort& effort) { return time_to_error(effort); },
          [](const Effort& effort) { return most_steps(effort.tv_gabor_pictures); }};
}

}  // namespace touchtrial::bench
