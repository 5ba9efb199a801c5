#include "analysis/planning/power_runs.hpp"

#include "analysis/planning/changes_words.hpp"
#include "core/hash.hpp"
#include "core/parallel.hpp"
#include "core/strict_json.hpp"
#include "device/simulated/simulated_hand.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::planning {
namespace {

std::string with_spread(const char* name, double value, double spread) {
  return std::string(name) + " " + number_text(value) + " (spread " + number_text(spread) + ")";
}

/// Tells subject models apart whose words are alike.
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

std::string words_of(const simulation::SubjectModel& subject) {
  std::string words =
      device::words_of_simulated(subject.device) + ", sense " +
      std::string(simulation::name_of_sense(subject.sense)) + ", " +
      with_spread("feature_noise", subject.feature_noise, subject.feature_noise_spread) + ", " +
      with_spread("lapse", subject.lapse, subject.lapse_spread) + ", " +
      with_spread("position bias", subject.position_bias, subject.position_bias_spread) +
      ", class bias spread " + number_text(subject.class_bias_spread);
  for (const simulation::ClassBias& bias : subject.class_bias) {
    words += ", bias for " + in_quotes(bias.label) + " " + number_text(bias.log_odds);
  }
  for (const auto& [one, other] : subject.label_swap) {
    words += ", " + in_quotes(one) + " swapped with " + in_quotes(other);
  }
  if (subject.hand != device::HandKind::point_mass || subject.hand_spread != 0.0) {
    words += ", hand " + std::string(device::name_of(subject.hand)) + " (spread " +
             number_text(subject.hand_spread) + ")";
  }
  return words + ", explores " + number_text(subject.explore_s) + " s at " +
         number_text(subject.slowest_mm_s) + " to " + number_text(subject.fastest_mm_s) +
         " mm/s with " + number_text(subject.push_n) + " N, " +
         std::to_string(subject.training_passes) + " training passes" + words_of_changes(subject) +
         "; all of it " + digest_of(subject);
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
