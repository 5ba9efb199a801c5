/// \file What a power run is to find out, and when it may stop. Source: docs/power.md.
#pragma once

#include "analysis/planning/rehearsed_study.hpp"
#include "analysis/statistics/proportion.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace touchtrial::planning {

/// The powers that sizes are asked for.
inline constexpr std::array<double, 2> kPowerTargets{0.8, 0.9};

inline constexpr int kMostPowerRuns = 100'000;
inline constexpr int kMostPowerParticipants = 10'000;
inline constexpr std::size_t kMostPowerSizes = 64;
/// Of all sizes together: what a file of progress holds without becoming unwieldy.
inline constexpr std::int64_t kMostPowerRunsInAll = 1'000'000;

struct PowerPlan {
  std::vector<int> participants;  ///< sizes, rising, each once
  int runs = 1000;                ///< simulated studies of each size and hypothesis
  std::uint64_t seed = 1;
  bool stop_early = true;
  bool servo = false;       ///< ServoFeelings
  int explorations = 1000;  ///< BankedFeelingsOptions
  int trainings = 16;

  friend bool operator==(const PowerPlan&, const PowerPlan&) = default;
};

/// Sorts the sizes.
/// \throws UsageError if a size comes twice or anything is out of range
void settle(PowerPlan& plan);

/// The part of a plan's runs that one of several machines makes: those with run % count + 1 ==
/// number, counted from 0.
struct Shard {
  int number = 1;  ///< 1 .. count
  int count = 1;

  [[nodiscard]] bool is_all() const noexcept { return count == 1; }
  /// How many of `runs` are its own.
  [[nodiscard]] int own_runs(int runs) const noexcept { return (runs - number + count) / count; }
  /// Which run its i-th is, from 0.
  [[nodiscard]] int run(int i) const noexcept { return number - 1 + i * count; }

  friend bool operator==(const Shard&, const Shard&) = default;
};

/// The seed of one simulated study, as `simulate --seed` takes it: its own for every size,
/// hypothesis and run, so that no two share a participant.
[[nodiscard]] std::uint64_t study_seed(std::uint64_t seed, int participants, Hypothesis hypothesis,
                                       int run);

/// After how many runs of a size it is asked whether more could change the answer: 100, 200, 400,
/// .. and the last run. Of a plan that does not stop early: the last run alone.
[[nodiscard]] std::vector<int> looks_of(const PowerPlan& plan);

/// The interval of a power from the first `runs.size()` runs. A plan that may stop early looks
/// several times, and its intervals hold together: Clopper-Pearson at 1 - 0.05 / looks each
/// (Bonferroni). A plan that may not: Wilson at 0.95.
[[nodiscard]] analysis::Interval power_interval(const PowerPlan& plan,
                                                analysis::Proportion significant);
/// The level of that interval, and its name in words.
[[nodiscard]] double power_level(const PowerPlan& plan);
[[nodiscard]] const char* power_interval_name(const PowerPlan& plan);

/// The first look after which every target lies outside the power's interval: the answer is
/// certain. A function of the runs' beginning alone.
/// \return how many runs that takes; nothing if these runs do not reach it
[[nodiscard]] std::optional<int> certain_after(const PowerPlan& plan,
                                               std::span<const PowerRun> runs);

}  // namespace touchtrial::planning
