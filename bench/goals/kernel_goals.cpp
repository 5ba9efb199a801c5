#include "bench/cases/cases.hpp"
#include "bench/goals/goal.hpp"
#include "bench/inputs/pictures.hpp"
#include "bench/measure/rows.hpp"
#include "bench/measure/simd_target.hpp"
#include "bench/measure/timing.hpp"
#include "bench/measure/tv_gabor_courses.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

namespace touchtrial::bench {
namespace {

constexpr double kAdaptiveTarget = 0.5;
/// The target without AVX-512.
constexpr double kAdaptiveAvx2Target = 0.75;
constexpr double kWideTarget = 0.05;
constexpr int kWideRadius = 7;
constexpr double kDaub4Target = 0.08;
constexpr double kTextureTarget = 1.6;  // of the machine's bound
constexpr double kHeightsTarget = 2.0;  // likewise
constexpr int kLargeSize_px = 4096;
constexpr double kMsSsimTarget = 0.25;
constexpr double kGlcmTarget = 0.5;
constexpr double kForceTarget_us = 0.03;

GoalResult result_of(const std::string& name, const Case& ours) {
  GoalResult result;
  result.goal = name;
  result.error = error_of(ours);
  result.error_unit = ours.accuracy.unit;
  return result;
}

void set_peer(const Case& peer, const TimeBeside& time, GoalResult& result) {
  result.peer = peer.who + (peer.input.empty() ? "" : ", " + peer.input);
  result.peer_us = time.us;
  result.ratio = time.ratio;
}

Goal ratio_goal(const std::string& name, const Case& ours, const Case& peer, double target) {
  return [=](const Effort& effort) {
    const std::vector<TimeBeside> times = time_in_turns({ours, peer}, effort);
    GoalResult result = result_of(name, ours);
    result.ours_us = times[0].us;
    set_peer(peer, times[1], result);
    result.target = target;
    return std::vector{result};
  };
}

Goal time_goal(const std::string& name, const Case& ours, double target_us) {
  return [=](const Effort& effort) {
    GoalResult result = result_of(name, ours);
    result.ours_us = time_in_turns({ours}, effort)[0].us;
    result.limit = Limit::time_us;
    result.target = target_us;
    return std::vector{result};
  };
}

/// A goal beside the larger of two bounds: streaming (in the faster of two ways) and arithmetic.
/// \param peers  the first is the goal's; the others are listed for the record
Goal bound_goal(const std::string& name, int size_px, const Case& ours, const Cases& peers,
                double target) {
  return [=](const Effort& effort) {
    Cases cases = {ours, arithmetic_case(size_px)};
    for (const Case& one : streaming_cases(size_px)) cases.push_back(one);
    const std::size_t first_peer = cases.size();
    cases.insert(cases.end(), peers.begin(), peers.end());
    const std::vector<TimeBeside> times = time_in_turns(cases, effort);
    const TimeBeside& streaming = times[2].us < times[3].us ? times[2] : times[3];
    const bool by_memory = streaming.us > times[1].us;
    std::vector<GoalResult> results;
    for (std::size_t i = 0; i < peers.size(); ++i) {
      GoalResult result = result_of(name, ours);
      result.ours_us = times[0].us;
      set_peer(peers[i], times[first_peer + i], result);
      result.bound = by_memory ? "memory" : "arithmetic";
      result.bound_us = (by_memory ? streaming : times[1]).us;
      result.of_bound = (by_memory ? streaming : times[1]).ratio;
      result.limit = Limit::of_bound;
      if (i == 0) result.target = target;
      results.push_back(result);
    }
    return results;
  };
}

/// On AVX-512, if the machine has it, and on AVX2.
void add_adaptive_goals(const std::vector<std::string>& targets, std::vector<Goal>& goals) {
  const Case peer = filter2d_case(kUsualSize_px, kUsualRadius, "f32");
  for (const std::string& target : targets) {
    const std::string set = instruction_set_of(target);
    if (set != "AVX-512" && set != "AVX2") continue;
    goals.push_back(ratio_goal("adaptive 5 x 5 on u8, " + set,
                               adaptive_filter_case(kUsualSize_px, kUsualRadius, target), peer,
                               set == "AVX2" ? kAdaptiveAvx2Target : kAdaptiveTarget));
  }
}

/// The goal's peer, and for the record a better optimised one.
void add_daub4_goals(std::vector<Goal>& goals) {
  const std::string name = "DAUB4, four bands";
  const Case ours = daub4_case(kUsualSize_px);
  goals.push_back(
      ratio_goal(name, ours, opencv_daub4_case(kUsualSize_px, Daub4Way::full_size), kDaub4Target));
  goals.push_back(
      ratio_goal(name, ours, opencv_daub4_case(kUsualSize_px, Daub4Way::by_rows), kNotTaken));
}

void add_extraction_goals(int size_px, std::vector<Goal>& goals) {
  const auto add = [&](const char* what, Extras extras, double target) {
    goals.push_back(bound_goal(fmt::format("{}, {} x {}", what, size_px, size_px), size_px,
                               extraction_case(size_px, kUsualRadius, extras),
                               {ring_sums_case(size_px, kUsualRadius, extras, RingSums::plain),
                                ring_sums_case(size_px, kUsualRadius, extras, RingSums::tuned)},
                               target));
  };
  add("adaptive texture", Extras::none, kTextureTarget);
  add("texture and what forces need", Extras::heights, kHeightsTarget);
}

constexpr double kTvGaborError = 1e-3;
constexpr double kTvGaborTimeTarget = 0.08;
constexpr double kTvGaborStepsTarget = 80;
constexpr int kFixedPointSteps = 1000;

constexpr double kTvGaborOfTransforms = 1.3;

/// The time until the error is small, beside that of the fixed point, whose error stays larger, and
/// beside that of the solver's own transforms.
std::vector<GoalResult> time_to_error(const Effort& effort) {
  GoalResult result;
  result.goal = "TV-Gabor, to 1e-3 of v";
  result.target = kTvGaborTimeTarget;
  const GreyImage image = square_of(timed_picture(), kUsualSize_px);
  const std::optional<CoursePoint> close = admm_until(image, kTvGaborError);
  if (!close) return {result};
  const Case peer = fixed_point_case(kUsualSize_px, kFixedPointSteps);
  const std::vector<TimeBeside> times = time_in_turns(
      {admm_case(kUsualSize_px, close->steps), peer, transforms_case(kUsualSize_px, close->steps)},
      effort);
  set_peer(peer, times[1], result);
  result.peer = fmt::format("{}, to {:.0e}", peer.who, error_of(peer));
  result.ours_us = times[0].us;
  result.error = close->error;
  result.error_unit = "of v";
  GoalResult of_transforms = result;
  of_transforms.goal = "TV-Gabor, beside its own transforms";
  of_transforms.bound = "transforms";
  of_transforms.bound_us = times[2].us;
  of_transforms.of_bound = times[2].ratio;
  of_transforms.limit = Limit::of_bound;
  of_transforms.target = kTvGaborOfTransforms;
  return {result, of_transforms};
}

std::vector<GoalResult> most_steps(int pictures) {
  GoalResult result;
  result.goal = "TV-Gabor, most steps to 1e-3 of v";
  result.count = 0.0;
  result.count_unit = "steps";
  result.limit = Limit::count;
  result.target = kTvGaborStepsTarget;
  for (const Picture& picture : shipped_pictures()) {
    if (picture.has_ground || pictures-- <= 0) break;
    const std::optional<CoursePoint> close = admm_until(picture.image, kTvGaborError);
    result.count = close ? std::max<double>(result.count, close->steps) : kNotTaken;
    if (!close) break;
  }
  return {result};
}

}  // namespace

std::vector<Goal> kernel_goals(const std::vector<std::string>& targets) {
  std::vector<Goal> goals;
  add_adaptive_goals(targets, goals);
  goals.push_back(ratio_goal("adaptive 15 x 15",
                             adaptive_filter_case(kUsualSize_px, kWideRadius, {}),
                             filter2d_case(kUsualSize_px, kWideRadius, "f32"), kWideTarget));
  add_daub4_goals(goals);
  add_extraction_goals(kUsualSize_px, goals);
  add_extraction_goals(kLargeSize_px, goals);
  goals.push_back(ratio_goal("MS-SSIM, five scales", ms_ssim_case<float>(kUsualSize_px),
                             opencv_ms_ssim_case(kUsualSize_px), kMsSsimTarget));
  goals.push_back(ratio_goal("GLCM and statistics", glcm_case(kUsualSize_px),
                             pair_loop_case(kUsualSize_px), kGlcmTarget));
  goals.push_back(time_goal("force evaluation, paper", paper_force_case(), kForceTarget_us));
  goals.push_back(time_goal("force evaluation, surface", surface_force_case(), kForceTarget_us));
  goals.emplace_back([](const Effort& effort) { return time_to_error(effort); });
  goals.emplace_back([](const Effort& effort) { return most_steps(effort.tv_gabor_pictures); });
  return goals;
}

}  // namespace touchtrial::bench
