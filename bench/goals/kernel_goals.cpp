#include "bench/cases/cases.hpp"
#include "bench/goals/goal.hpp"
#include "bench/inputs/simd_name.hpp"
#include "bench/measure/pair.hpp"
#include "bench/measure/rows.hpp"

#include <algorithm>

namespace touchtrial::bench {
namespace {

constexpr double kAdaptiveTarget = 0.5;
/// On an older instruction set than AVX-512.
constexpr double kAdaptiveAvx2Target = 0.75;
constexpr double kWideTarget = 0.05;
constexpr int kWideRadius = 7;
constexpr double kDaub4Target = 0.08;
constexpr double kPipelineTarget = 0.08;
constexpr double kLargePipelineTarget = 0.05;
constexpr int kLargeSize_px = 4096;
constexpr double kMsSsimTarget = 0.25;
constexpr double kGlcmTarget = 0.5;
constexpr double kForceTarget_us = 0.03;

GoalResult without_peer(const std::string& name, const Case& ours) {
  GoalResult result;
  result.goal = name;
  result.error = error_of(ours);
  result.error_unit = ours.accuracy.unit;
  return result;
}

Goal ratio_goal(const std::string& name, const Case& ours, const Case& peer, double target) {
  return [=](const Effort& effort) {
    const PairTimes times = time_pair(ours, peer, effort);
    GoalResult result = without_peer(name, ours);
    result.peer = peer.who + (peer.input.empty() ? "" : ", " + peer.input);
    result.ours_us = times.ours_us;
    result.peer_us = times.peer_us;
    result.ratio = times.ratio;
    result.target = target;
    return std::vector{result};
  };
}

Goal time_goal(const std::string& name, const Case& ours, double target_us) {
  return [=](const Effort& effort) {
    GoalResult result = without_peer(name, ours);
    result.ours_us = time_alone(ours, effort).ours_us;
    result.limit = Limit::time_us;
    result.target = target_us;
    return std::vector{result};
  };
}

/// AVX-512 if the machine has it, and AVX2.
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

/// Beside the peer of the goal, one that works harder, for the record.
void add_daub4_goals(std::vector<Goal>& goals) {
  const std::string name = "DAUB4, four bands";
  const Case ours = daub4_case(kUsualSize_px);
  goals.push_back(
      ratio_goal(name, ours, opencv_daub4_case(kUsualSize_px, Daub4Way::full_size), kDaub4Target));
  goals.push_back(
      ratio_goal(name, ours, opencv_daub4_case(kUsualSize_px, Daub4Way::by_rows), kNotTaken));
}

void add_extraction_goals(const std::string& name, int size_px, double target,
                          std::vector<Goal>& goals) {
  const Case ours = extraction_case(size_px, kUsualRadius, Extras::force);
  const auto peer = [=](RingSums how) {
    return ring_sums_case(size_px, kUsualRadius, Extras::force, how);
  };
  goals.push_back(ratio_goal(name, ours, peer(RingSums::plain), target));
  goals.push_back(ratio_goal(name, ours, peer(RingSums::tuned), kNotTaken));
}

}  // namespace

std::vector<Goal> kernel_goals(const std::vector<std::string>& targets) {
  std::vector<Goal> goals;
  add_adaptive_goals(targets, goals);
  goals.push_back(ratio_goal("adaptive 15 x 15",
                             adaptive_filter_case(kUsualSize_px, kWideRadius, {}),
                             filter2d_case(kUsualSize_px, kWideRadius, "f32"), kWideTarget));
  add_daub4_goals(goals);
  add_extraction_goals("extraction and force planes", kUsualSize_px, kPipelineTarget, goals);
  add_extraction_goals("the same, 4096 x 4096", kLargeSize_px, kLargePipelineTarget, goals);
  goals.push_back(ratio_goal("MS-SSIM, five scales", ms_ssim_case<float>(kUsualSize_px),
                             opencv_ms_ssim_case(kUsualSize_px), kMsSsimTarget));
  goals.push_back(ratio_goal("GLCM and statistics", glcm_case(kUsualSize_px),
                             pair_loop_case(kUsualSize_px), kGlcmTarget));
  goals.push_back(time_goal("force evaluation, paper", paper_force_case(), kForceTarget_us));
  goals.push_back(time_goal("force evaluation, surface", surface_force_case(), kForceTarget_us));
  return goals;
}

}  // namespace touchtrial::bench
