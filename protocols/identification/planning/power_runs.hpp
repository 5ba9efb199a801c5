/// \file The simulated studies of a power analysis, and their results. Source: docs/planning.md.
#pragma once

#include "analysis/planning/power_plan.hpp"
#include "protocols/identification/planning/primary_test.hpp"
#include "protocols/identification/planning/rehearsed_study.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::planning::identification {

/// The report states the required size for these powers.
inline constexpr std::array<double, 2> kPowerTargets{0.8, 0.9};

/// The seed of one simulated study, as in `simulate --seed`. Every size, hypothesis and run has its
/// own seed, so that no two studies share a participant.
[[nodiscard]] std::uint64_t study_seed(std::uint64_t seed, int participants, Hypothesis hypothesis,
                                       int run);

/// PowerSetting::fields if participants do not feel the stimuli.
inline constexpr std::string_view kNoFields = "none";

/// The input of a power analysis. Equal settings and plans simulate the same studies.
struct PowerSetting {
  std::string study;     ///< name
  std::string protocol;  ///< name
  std::string test;      ///< words_of the primary test
  std::string estimate;  ///< estimate_words
  std::string seal;  ///< study_seal of the simulated key, which covers the study file; hexadecimal
  std::string fields;   ///< SHA-256 of the force fields, hexadecimal; or kNoFields
  std::string subject;  ///< words_of the subject model or the stated people
  std::string program;  ///< program version
  /// Whether every participant's order presents every class equally often. Otherwise all results
  /// depend on the orders drawn by the study's seed, because they change the effect of a bias.
  bool has_fixed_counts = true;
  std::string device{};  ///< analysis::device_words of the subject's device

  /// Whether participants feel the study's textures; otherwise their accuracy is stated.
  [[nodiscard]] bool feels() const { return fields != kNoFields; }
};

/// The studies of one size and hypothesis.
struct PowerCell {
  int participants = 0;
  Hypothesis hypothesis = Hypothesis::population;
  std::vector<PowerRun> runs;  ///< by run number

  friend bool operator==(const PowerCell&, const PowerCell&) = default;
};

struct PowerRuns {
  PowerSetting setting;
  PowerPlan plan;                ///< with the test's level and margin
  std::vector<PowerCell> cells;  ///< by size; for each, the population, then the null
};

/// Runs a plan. The results depend only on setting and plan, not on the number of threads.
/// \param study  constructed for at least the plan's largest size
/// \param jobs  number of threads, >= 1
/// \param progress  called from one thread between blocks of runs
[[nodiscard]] PowerRuns make_runs(
    const Rehearsal& study, const PrimaryTest& test, PowerSetting setting, const PowerPlan& plan,
    int jobs, const std::function<void(int finished, int total)>& progress = {});

}  // namespace touchtrial::planning::identification
