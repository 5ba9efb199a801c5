/// \file How far a power run is: every simulated study's figures. Written to a file as it goes, so
/// that it can be taken up after a crash, and put together from several machines' parts.
/// Format: docs/power.md, "Files".
#pragma once

#include "analysis/planning/power_plan.hpp"
#include "analysis/planning/primary_test.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial::planning {

/// What a power run is of. Two runs with equal figures here and an equal plan make equal studies.
struct PowerSetting {
  std::string study;     ///< its name
  std::string protocol;  ///< name_of
  std::string test;      ///< words_of
  std::string estimate;  ///< estimate_words
  std::string seal;      ///< study_seal of the simulated key, hexadecimal: the whole study file
  std::string fields;    ///< SHA-256 over the force fields that are felt, hexadecimal
  std::string subject;   ///< the subject model's figures, in words
  std::string program;   ///< version
  /// Whether every participant's order presents every class as often. If not, right answers that a
  /// bias gives depend on the orders that the study's seed draws, and so do all figures.
  bool has_fixed_counts = true;

  friend bool operator==(const PowerSetting&, const PowerSetting&) = default;
};

/// A subject model's figures on one line: "weber 0.28 (spread 0.2), lapse 0.02 (spread 0), ..".
[[nodiscard]] std::string words_of(const session::SubjectModel& subject);

/// The studies of one size and hypothesis.
struct PowerCell {
  int participants = 0;
  Hypothesis hypothesis = Hypothesis::population;
  std::vector<PowerRun> runs;  ///< a shard's own, in their order; a beginning of them

  friend bool operator==(const PowerCell&, const PowerCell&) = default;
};

struct PowerProgress {
  PowerSetting setting;
  PowerPlan plan;  ///< settled
  Shard shard;
  std::vector<PowerCell> cells;  ///< by size, the population before the null

  friend bool operator==(const PowerProgress&, const PowerProgress&) = default;
};

/// With no run made yet.
[[nodiscard]] PowerProgress new_progress(PowerSetting setting, const PowerPlan& plan,
                                         const Shard& shard);

/// How many runs a cell has when it is done: all of the shard's own, or as many as make the answer
/// certain. A shard does not stop early: it does not see the others.
/// \return nothing if that is not known yet
[[nodiscard]] std::optional<int> runs_when_done(const PowerProgress& progress,
                                                const PowerCell& cell);
[[nodiscard]] bool is_complete(const PowerProgress& progress);

/// What two have differently, in words for an error ("the seed"), of study, plan and program;
/// empty: nothing. Shards do not count.
[[nodiscard]] std::string first_difference(const PowerProgress& a, const PowerProgress& b);

/// One JSON object with its own SHA-256.
[[nodiscard]] std::string progress_json(const PowerProgress& progress);
/// \throws FileError if the file is missing, too large, truncated, altered or not of this format
[[nodiscard]] PowerProgress load_progress(const std::filesystem::path& path);

/// The whole from all its shards, in any order. A shard that is there several times, and equal, is
/// taken once.
struct CombinedPower {
  PowerProgress progress;
  std::vector<std::string> remarks;  ///< one line each: what was taken once
};
/// \throws VerificationError if two files of one shard differ, or a shard is of another study, plan
///   or program, naming the file
/// \throws FileError if shards are missing, naming which, or not complete
[[nodiscard]] CombinedPower combined(
    const std::vector<std::pair<std::filesystem::path, PowerProgress>>& shards);

}  // namespace touchtrial::planning
