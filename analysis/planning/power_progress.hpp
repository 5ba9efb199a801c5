/// \file How far a power run is: the numbers of every simulated study; making the runs; combining
/// the shards of several machines. A run keeps its progress in a file, so that it can be resumed.
/// Format: docs/power.md, "Files".
#pragma once

#include "analysis/planning/power_plan.hpp"
#include "analysis/planning/primary_test.hpp"
#include "protocols/simulation/subject_model.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace touchtrial::planning {

/// In place of the hash of fields: nobody feels anything.
inline constexpr std::string_view kNoFields = "none";

/// What a power run simulates. Two runs with equal settings and plans simulate the same studies.
struct PowerSetting {
  std::string study;     ///< its name
  std::string protocol;  ///< its name
  std::string test;      ///< words_of the primary test
  std::string estimate;  ///< estimate_words
  std::string seal;      ///< study_seal of the simulated key, hexadecimal: the whole study file
  std::string fields;    ///< SHA-256 of the force fields that are felt, hexadecimal; or kNoFields
  std::string subject;   ///< words_of the subject model, or of the stated people
  std::string program;   ///< version
  int draws = 0;         ///< of a fit, from which each study takes one; 0: nothing is uncertain
  /// Whether every participant's order presents every class equally often. Otherwise the right
  /// answers that a bias gives, and so all numbers, depend on the orders that the study's seed
  /// draws.
  bool has_fixed_counts = true;
  std::string device{};  ///< analysis::device_words of what the subject holds

  /// Whether people feel the study's textures; otherwise only how often they are right is stated.
  [[nodiscard]] bool feels() const { return fields != kNoFields; }

  friend bool operator==(const PowerSetting&, const PowerSetting&) = default;
};

/// \return a subject model on one line: "feature_noise 0.28 (spread 0.2), lapse 0.02 (spread 0), .."
[[nodiscard]] std::string words_of(const simulation::SubjectModel& subject);

/// The studies of one size and hypothesis.
struct PowerCell {
  int participants = 0;
  Hypothesis hypothesis = Hypothesis::population;
  std::vector<PowerRun> runs;  ///< those that the shard has made so far, in order

  friend bool operator==(const PowerCell&, const PowerCell&) = default;
};

struct PowerProgress {
  PowerSetting setting;
  PowerPlan plan;  ///< settled
  Shard shard;
  std::vector<PowerCell> cells;  ///< by size, the population before the null

  friend bool operator==(const PowerProgress&, const PowerProgress&) = default;
};

/// \return progress without any run
[[nodiscard]] PowerProgress new_progress(PowerSetting setting, const PowerPlan& plan,
                                         const Shard& shard);

/// The number of runs of a finished cell: all of the shard's own, or as many as make the answer
/// certain. One shard of several does not stop early, because it does not see the others.
/// \return nothing if the number is not known yet
[[nodiscard]] std::optional<int> runs_when_done(const PowerProgress& progress,
                                                const PowerCell& cell);
[[nodiscard]] bool is_complete(const PowerProgress& progress);

/// \return the first difference between two runs' studies, plans or programs, as an error names it
///   ("--seed"); empty if there is none. Shards are not compared.
[[nodiscard]] std::string first_difference(const PowerProgress& a, const PowerProgress& b);

struct PowerWork {
  int jobs = 1;  ///< threads, >= 1; results do not depend on them
  /// Called between blocks of runs, from one thread, with the progress so far.
  std::function<void(const PowerProgress&)> keep{};
  std::function<void(int done, int of)> progress{};
};

/// Makes the missing runs. The finished progress depends on setting, plan and shard alone, not on
/// what was there before or on the number of threads.
/// \param study  made for at least the plan's largest size
/// \throws what `keep` throws; `progress` is then as it was kept
void make_runs(const Rehearsal& study, const PrimaryTest& test, const PowerWork& work,
               PowerProgress& progress);

/// \return one JSON object with its own SHA-256
[[nodiscard]] std::string progress_json(const PowerProgress& progress);
/// \throws FileError if the file is missing, too large, truncated, altered or not of this format
[[nodiscard]] PowerProgress load_progress(const std::filesystem::path& path);

struct CombinedPower {
  PowerProgress progress;            ///< of the whole run
  std::vector<std::string> remarks;  ///< one line for each file that repeats a shard
};

/// Combines all shards of a run, in any order. A shard in several equal files is taken once.
/// \throws VerificationError if two files of one shard differ, or a shard is of another study, plan
///   or program; the error names the file
/// \throws FileError if shards are missing, which it names, or not complete
[[nodiscard]] CombinedPower combined(
    const std::vector<std::pair<std::filesystem::path, PowerProgress>>& files);

}  // namespace touchtrial::planning
