/// \file The plan of a power run: sizes, runs and seeds. Source: docs/power.md.
#pragma once

#include "analysis/planning/rehearsed_study.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace touchtrial::planning {

/// The powers that a size may reach.
inline constexpr std::array<double, 2> kPowerTargets{0.8, 0.9};

inline constexpr int kMostPowerRuns = 100'000;
inline constexpr int kMostPowerParticipants = 10'000;
inline constexpr std::size_t kMostPowerSizes = 64;
/// Runs of all sizes together.
inline constexpr std::int64_t kMostPowerRunsInAll = 1'000'000;

struct PowerPlan {
  std::vector<int> participants;  ///< sizes, rising, each once
  int runs = 1000;                ///< simulated studies of each size and hypothesis
  std::uint64_t seed = 1;
  bool servo = false;            ///< use ServoFeelings
  int explorations = 1000;       ///< BankedFeelingsOptions
  int trainings = 16;            ///< BankedFeelingsOptions
  double level = 0.05;           ///< of the primary test
  double margin = 0.0;           ///< of the primary test; 0: none
  double first_half_loss = 0.0;  ///< RehearsalOptions
  double effect = 0.0;           ///< RehearsalOptions; 0: the subject's own
};

/// Sorts the sizes and checks the plan.
/// \throws UsageError if a size appears twice or a number is out of range
void settle(PowerPlan& plan);

/// The seed of one simulated study, as for `simulate --seed`. Every size, hypothesis and run has
/// its own seed, so that no two studies share a participant.
[[nodiscard]] std::uint64_t study_seed(std::uint64_t seed, int participants, Hypothesis hypothesis,
                                       int run);

}  // namespace touchtrial::planning
