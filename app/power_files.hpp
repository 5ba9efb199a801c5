/// \file The files of a power run: progress, shards and results. Their formats: docs/power.md.
#pragma once

#include "analysis/planning/power_progress.hpp"
#include "analysis/planning/power_report.hpp"

#include <chrono>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

namespace touchtrial::app {

/// A shard as it is typed: "3/16".
/// \throws UsageError if the text is anything else, or not 1 <= number <= count <= 10,000
[[nodiscard]] planning::Shard shard_named(std::string_view text);

/// The file of a run's progress: "power-progress.json" in its folder.
[[nodiscard]] std::filesystem::path progress_file(const std::filesystem::path& folder);

/// The file of a shard, even of the only one: "shard-0003-of-0016.json".
[[nodiscard]] std::filesystem::path shard_file(const std::filesystem::path& folder,
                                               const planning::Shard& shard);

/// The progress of a run in a file, or `fresh` if there is no file.
/// \param resume  whether the file may exist
/// \throws FileError if the file exists and may not, is malformed, or belongs to another run
[[nodiscard]] planning::PowerProgress taken_up(const std::filesystem::path& file,
                                               planning::PowerProgress fresh, bool resume);

/// Writes progress as often as it costs little time, and always when it is complete.
class ProgressKeeper {
 public:
  explicit ProgressKeeper(std::filesystem::path file) : file_(std::move(file)) {}
  /// \throws FileError if the file cannot be written
  void keep(const planning::PowerProgress& progress);

 private:
  using Clock = std::chrono::steady_clock;

  std::filesystem::path file_;
  Clock::time_point next_{};  ///< the earliest time of the next write
};

/// Loads shards from files and from folders, of which it takes every "shard-*.json" by name.
/// \throws FileError if a folder contains no shard, or a file cannot be read
[[nodiscard]] std::vector<std::pair<std::filesystem::path, planning::PowerProgress>> load_shards(
    const std::vector<std::filesystem::path>& places);

/// Before long work: refuses a folder in which one of the results' places has another's file.
/// \throws as require_output_place
void require_power_places(const std::filesystem::path& folder);

/// Writes power.json, power.csv, power.md, power.svg and power.pdf. Without gnuplot it warns, and
/// omits the last two.
/// \throws as write_output
void write_power_results(const std::filesystem::path& folder, const planning::PowerReport& report);

}  // namespace touchtrial::app
