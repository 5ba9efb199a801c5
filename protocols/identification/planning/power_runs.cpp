#include "protocols/identification/planning/power_runs.hpp"

#include "core/parallel.hpp"
#include "core/random.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::planning::identification {
namespace {

constexpr int kRunsPerBlock = 50;

void run_block(const Rehearsal& study, const PrimaryTest& test, const PowerPlan& plan, int jobs,
               int first, PowerCell& cell) {
  const int end = std::min(plan.runs, first + kRunsPerBlock);
  in_parallel(jobs, static_cast<std::size_t>(end - first), [&](std::size_t i) {
    const int run = first + static_cast<int>(i);
    const std::uint64_t seed = study_seed(plan.seed, cell.participants, cell.hypothesis, run);
    cell.runs[static_cast<std::size_t>(run)] =
        analyse_run(test, study.outcomes(cell.participants, cell.hypothesis, seed),
                    cell.hypothesis == Hypothesis::null);
  });
}

}  // namespace

std::uint64_t study_seed(std::uint64_t seed, int participants, Hypothesis hypothesis, int run) {
  const std::string purpose =
      fmt::format("power: {}, {} participants", name_of(hypothesis), participants);
  return RandomStream(seed, purpose, static_cast<std::uint64_t>(run)).bits();
}

PowerRuns make_runs(const Rehearsal& study, const PrimaryTest& test, PowerSetting setting,
                    const PowerPlan& plan, int jobs,
                    const std::function<void(int finished, int total)>& progress) {
  PowerRuns power{std::move(setting), plan, {}};
  for (const int size : plan.participants) {
    for (const Hypothesis hypothesis : {Hypothesis::population, Hypothesis::null}) {
      power.cells.push_back(
          {size, hypothesis, std::vector<PowerRun>(static_cast<std::size_t>(plan.runs))});
    }
  }
  // Progress counts simulated participants, because computing time is proportional to them.
  double total = 0.0;
  for (const int size : plan.participants) total += 2.0 * plan.runs * size;
  double finished_people = 0.0;
  for (PowerCell& cell : power.cells) {
    for (int first = 0; first < plan.runs; first += kRunsPerBlock) {
      run_block(study, test, plan, jobs, first, cell);
      finished_people +=
          static_cast<double>(std::min(kRunsPerBlock, plan.runs - first)) * cell.participants;
      constexpr int kSteps = 1000;
      if (progress) progress(static_cast<int>(kSteps * finished_people / total), kSteps);
    }
  }
  return power;
}

}  // namespace touchtrial::planning::identification
