#include "analysis/planning/power_runs.hpp"

#include "core/errors.hpp"
#include "core/hash.hpp"
#include "core/parallel.hpp"
#include "core/random.hpp"
#include "core/strict_json.hpp"
#include "device/drivers/simulated/simulated_hand.hpp"

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>

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

/// Tells subject models apart: words name the main numbers alone.
std::string digest_of(const simulation::SubjectModel& subject) {
  constexpr std::size_t kShown = 12;
  FieldHasher hasher;
  hasher.add(simulation::subject_model_json(subject));
  hasher.add(device::device_model_json(subject.device));
  return to_hex(hasher.finish()).substr(0, kShown);
}

/// The number of runs between two reports of progress.
constexpr int kBlock = 50;

void make_block(const Rehearsal& study, const PrimaryTest& test, const PowerPlan& plan, int jobs,
                int first, PowerCell& cell) {
  const int end = std::min(plan.runs, first + kBlock);
  in_parallel(jobs, static_cast<std::size_t>(end - first), [&](std::size_t i) {
    const int run = first + static_cast<int>(i);
    const std::uint64_t seed = study_seed(plan.seed, cell.participants, cell.hypothesis, run);
    cell.runs[static_cast<std::size_t>(run)] =
        judged(test, study.outcomes(cell.participants, cell.hypothesis, seed),
               cell.hypothesis == Hypothesis::null);
  });
}

}  // namespace

void settle(PowerPlan& plan) {
  settle_sizes(plan);
  require_range("--runs", plan.runs, 1, kMostPowerRuns);
  require_range("--explorations", plan.explorations, 1, kMostExplorations);
  require_range("--trainings", plan.trainings, 1, kMostTrainings);
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

std::string words_of(const simulation::SubjectModel& subject) {
  return fmt::format(
      "{}, {}, sense {}, feature_noise {} (spread {}), lapse {} (spread {}); all of it {}",
      subject.source.empty() ? "built-in subject"
                             : one_line(std::filesystem::path(subject.source).filename().string()),
      device::words_of_simulated(subject.device), simulation::name_of_sense(subject.sense),
      number_text(subject.feature_noise), number_text(subject.feature_noise_spread),
      number_text(subject.lapse), number_text(subject.lapse_spread), digest_of(subject));
}

PowerRuns make_runs(const Rehearsal& study, const PrimaryTest& test, PowerSetting setting,
                    const PowerPlan& plan, int jobs,
                    const std::function<void(int done, int of)>& progress) {
  PowerRuns power{std::move(setting), plan, {}};
  for (const int size : plan.participants) {
    for (const Hypothesis hypothesis : {Hypothesis::population, Hypothesis::null}) {
      power.cells.push_back(
          {size, hypothesis, std::vector<PowerRun>(static_cast<std::size_t>(plan.runs))});
    }
  }
  // Progress counts participants, because they cost the time.
  double people = 0.0;
  for (const int size : plan.participants) people += 2.0 * plan.runs * size;
  double done = 0.0;
  for (PowerCell& cell : power.cells) {
    for (int first = 0; first < plan.runs; first += kBlock) {
      make_block(study, test, plan, jobs, first, cell);
      done += static_cast<double>(std::min(kBlock, plan.runs - first)) * cell.participants;
      constexpr int kSteps = 1000;
      if (progress) progress(static_cast<int>(kSteps * done / people), kSteps);
    }
  }
  return power;
}

}  // namespace touchtrial::planning
