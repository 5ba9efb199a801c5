/// \file Where a power run keeps what it has: progress, shards, results. Format: docs/power.md.
#pragma once

#include "analysis/planning/power_progress.hpp"
#include "analysis/planning/power_report.hpp"

#include <chrono>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace touchtrial::app {

/// "3/16" \throws UsageError if it is none, or not 1 <= number <= count <= 10,000
[[nodiscard]] planning::Shard shard_named(std::string_view text);

/// "8,12,16" \throws UsageError if a part of it is no whole number
[[nodiscard]] std::vector<int> sizes_named(std::string_view text);

/// The file of a run's progress in its folder: "power-progress.json".
[[nodiscard]] std::filesystem::path progress_file(const std::filesystem::path& folder);
/// Of a shard, also of the only one: "shard-0003-of-0016.json".
[[nodiscard]] std::filesystem::path shard_file(const std::filesystem::path& folder,
                                               const planning::Shard& shard);

/// What a file already has of a run.
/// \param resume  whether there may be one
/// \return `fresh` if there is none
/// \throws FileError if there is one and may not be, it is malformed, or of another run
[[nodiscard]] planning::PowerProgress taken_up(const std::filesystem::path& file,
                                               planning::PowerProgress fresh, bool resume);

/// Writes progress now and then, and always when it is complete: as often as costs little.
class ProgressKeeper {
 public:
  explicit ProgressKeeper(std::filesystem::path file) : file_(std::move(file)) {}
  /// \throws FileError if the file cannot be written
  void keep(const planning::PowerProgress& progress);

 private:
  using Clock = std::chrono::steady_clock;

  std::filesystem::path file_;
  Clock::time_point next_{};  ///< nothing is written before
};

/// Files as given, and of folders every "shard-*.json", by name.
/// \throws FileError if a folder has none, or a file cannot be read
[[nodiscard]] std::vector<std::pair<std::filesystem::path, planning::PowerProgress>> load_shards(
    const std::vector<std::filesystem::path>& places);

/// power.json, power.csv, power.md, power.svg and power.pdf. Without gnuplot the last two are left
/// out, with a line on standard error. \throws FileError
void write_power_results(const std::filesystem::path& folder, const planning::PowerReport& report);

}  // namespace touchtrial::app
