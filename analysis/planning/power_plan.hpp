/// \file The plan of a power run: sizes, runs and shards, and when a size may stop early.
/// Source: docs/power.md.
#pragma once

#include "analysis/planning/rehearsed_study.hpp"
#include "analysis/statistics/proportion.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace touchtrial::planning {

/// The powers that a size may reach.
inline constexpr std::array<double, 2> kPowerTargets{0.8, 0.9};

inline constexpr int kMostPowerRuns = 100'000;
inline constexpr int kMostPowerParticipants = 10'000;
inline constexpr std::size_t kMostPowerSizes = 64;
inline constexpr int kMostShards = 10'000;
/// Runs of all sizes together, so that a file of progress stays manageable.
inline constexpr std::int64_t kMostPowerRunsInAll = 1'000'000;

struct PowerPlan {
  std::vector<int> participants;  ///< sizes, rising, each once
  int runs = 1000;                ///< simulated studies of each size and hypothesis
  std::uint64_t seed = 1;
  bool stop_early = true;
  bool servo = false;            ///< use ServoFeelings
  int explorations = 1000;       ///< BankedFeelingsOptions
  int trainings = 16;            ///< BankedFeelingsOptions
  double level = 0.05;           ///< of the primary test
  double margin = 0.0;           ///< of the primary test; 0: none
  double first_half_loss = 0.0;  ///< RehearsalOptions
  double effect = 0.0;           ///< RehearsalOptions; 0: the subject's own

  friend bool operator==(const PowerPlan&, const PowerPlan&) = default;
};

/// Sorts the sizes and checks the plan.
/// \throws UsageError if a size appears twice or a number is out of range
void settle(PowerPlan& plan);

/// The part of a plan's runs that one of several machines makes. Shard `number` makes the runs with
/// run % count + 1 == number; runs count from 0.
struct Shard {
  int number = 1;  ///< 1 .. count
  int count = 1;

  [[nodiscard]] bool is_all() const noexcept { return count == 1; }
  /// How many of a plan's runs belong to the shard.
  [[nodiscard]] int own_runs(int runs) const noexcept { return (runs - number + count) / count; }
  /// The shard's i-th run; both count from 0.
  [[nodiscard]] int run(int i) const noexcept { return number - 1 + i * count; }

  friend bool operator==(const Shard&, const Shard&) = default;
};

/// The seed of one simulated study, as for `simulate --seed`. Every size, hypothesis and run has
/// its own seed, so that no two studies share a participant.
[[nodiscard]] std::uint64_t study_seed(std::uint64_t seed, int participants, Hypothesis hypothesis,
                                       int run);

/// The numbers of runs after which a size may stop early: 100, 200, 400, .. and the plan's last
/// run; only the last run if the plan does not stop early.
[[nodiscard]] std::vector<int> looks_of(const PowerPlan& plan);

/// The interval of a power. If the plan may stop early, it looks several times, and the intervals
/// hold together: Clopper-Pearson, each at 1 - 0.05 / looks (Bonferroni). Otherwise: Wilson at
/// 0.95.
[[nodiscard]] analysis::Interval power_interval(const PowerPlan& plan,
                                                analysis::Proportion significant);
/// The level and the name of that interval.
[[nodiscard]] double power_level(const PowerPlan& plan);
[[nodiscard]] const char* power_interval_name(const PowerPlan& plan);

/// The first look at which every target lies outside the power's interval, so that the answer is
/// certain. Later runs do not change it.
/// \return the number of runs at that look; nothing if these runs do not reach it
[[nodiscard]] std::optional<int> certain_after(const PowerPlan& plan,
                                               std::span<const PowerRun> runs);

}  // namespace touchtrial::planning
