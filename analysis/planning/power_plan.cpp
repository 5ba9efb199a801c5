#include "analysis/planning/power_plan.hpp"

#include "core/errors.hpp"
#include "core/random.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

namespace touchtrial::planning {
namespace {

constexpr int kMostExplorations = 100'000;
constexpr int kMostTrainings = 1'000;

void require_range(const char* option, int value, int low, int high) {
  if (value >= low && value <= high) return;
  throw UsageError(fmt::format("{}: {} is out of range; give {} to {}", option, value, low, high));
}

void settle_sizes(PowerPlan& plan) {
  if (plan.participants.empty()) {
    throw UsageError("--participants: no size is given; give one or more, for instance 8,12,16");
  }
  if (plan.participants.size() > kMostPowerSizes) {
    throw UsageError(fmt::format("--participants: {} sizes are given; give {} at most",
                                 plan.participants.size(), kMostPowerSizes));
  }
  for (const int size : plan.participants) {
    // One participant gives no interval over participants.
    require_range("--participants", size, 2, kMostPowerParticipants);
  }
  std::ranges::sort(plan.participants);
  const auto twice = std::ranges::adjacent_find(plan.participants);
  if (twice != plan.participants.end()) {
    throw UsageError(fmt::format("--participants: {} is given twice; give each size once", *twice));
  }
}

}  // namespace

void settle(PowerPlan& plan) {
  settle_sizes(plan);
  require_range("--runs", plan.runs, 1, kMostPowerRuns);
  require_range("--explorations", plan.explorations, 1, kMostExplorations);
  require_range("--trainings", plan.trainings, 1, kMostTrainings);
  if (!(plan.effect >= -1.0 && plan.effect <= 1.0)) {
    throw UsageError(
        fmt::format("--effect: {:.4g} is out of range; give a share from -1 to 1", plan.effect));
  }
  if (!(plan.first_half_loss >= 0.0 && plan.first_half_loss <= 1.0)) {
    throw UsageError(fmt::format("--first-half-loss: {} is out of range; give a share from 0 to 1",
                                 plan.first_half_loss));
  }
  const std::int64_t all =
      static_cast<std::int64_t>(plan.participants.size()) * std::int64_t{plan.runs};
  if (all > kMostPowerRunsInAll) {
    throw UsageError(fmt::format(
        "--runs: {} runs of {} sizes are {} in all; give fewer runs or sizes, {} in all at most",
        plan.runs, plan.participants.size(), all, kMostPowerRunsInAll));
  }
}

std::uint64_t study_seed(std::uint64_t seed, int participants, Hypothesis hypothesis, int run) {
  const std::string purpose =
      fmt::format("power: {}, {} participants", name_of(hypothesis), participants);
  return RandomStream(seed, purpose, static_cast<std::uint64_t>(run)).bits();
}

}  // namespace touchtrial::planning
