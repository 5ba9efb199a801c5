#include "app/power_files.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/outputs.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> shards_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("shard-") && name.ends_with(".json")) files.push_back(entry.path());
  }
  if (files.empty()) {
    throw FileError(
        one_line(folder.string()) +
        ": contains no shard of a power run (shard-*.json); give the --out folder of the shards");
  }
  std::ranges::sort(files);
  return files;
}

void draw(const fs::path& folder, const analysis::Figure& figure, analysis::FigureFormat format,
          const char* name) {
  write_output(folder / name, analysis::drawn(figure, format));
}

}  // namespace

planning::Shard shard_named(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash != std::string_view::npos && slash > 0 && slash + 1 < text.size()) {
    const auto number = number_in<int>(text.substr(0, slash));
    const auto count = number_in<int>(text.substr(slash + 1));
    if (number && count && *number >= 1 && *number <= *count && *count <= planning::kMostShards) {
      return {*number, *count};
    }
  }
  throw UsageError(one_line(
      fmt::format("--shard: '{}' is not a shard; give its number and the count, from 1/1 to {}/{}",
                  text.substr(0, 60), planning::kMostShards, planning::kMostShards)));
}

fs::path progress_file(const fs::path& folder) {
  return folder / "power-progress.json";
}

fs::path shard_file(const fs::path& folder, const planning::Shard& shard) {
  return folder / fmt::format("shard-{:04}-of-{:04}.json", shard.number, shard.count);
}

planning::PowerProgress taken_up(const fs::path& file, planning::PowerProgress fresh, bool resume) {
  if (!is_there(file)) return fresh;
  if (!resume) {
    throw FileError(one_line(file.string()) +
                    ": exists already; continue it with --resume, or give another --out");
  }
  planning::PowerProgress kept = planning::load_progress(file);
  const std::string difference =
      kept.shard == fresh.shard ? planning::first_difference(kept, fresh) : "--shard";
  if (!difference.empty()) {
    throw FileError(one_line(file.string()) + ": belongs to another run (" + difference +
                    " differs); resume it with its own arguments, or give another --out");
  }
  return kept;
}

std::vector<std::pair<fs::path, planning::PowerProgress>> load_shards(
    const std::vector<fs::path>& places) {
  std::vector<std::pair<fs::path, planning::PowerProgress>> shards;
  for (const fs::path& place : places) {
    std::error_code error;
    const bool is_folder = fs::is_directory(place, error);
    for (const fs::path& file : is_folder ? shards_in(place) : std::vector{place}) {
      shards.emplace_back(file, planning::load_progress(file));
    }
  }
  return shards;
}

void require_power_places(const fs::path& folder) {
  for (const char* name : {"power.json", "power.csv", "power.md", "power.svg", "power.pdf"}) {
    require_output_place(folder / name);
  }
}

void write_power_results(const fs::path& folder, const planning::PowerReport& report) {
  write_output(folder / "power.json", planning::power_json(report));
  write_output(folder / "power.csv", planning::power_csv(report));
  write_output(folder / "power.md", planning::power_markdown(report));
  const analysis::Figure figure = planning::power_figure(report);
  try {
    draw(folder, figure, analysis::FigureFormat::svg, "power.svg");
    draw(folder, figure, analysis::FigureFormat::pdf, "power.pdf");
  } catch (const FileError&) {
    throw;
  } catch (const Error& error) {
    spdlog::warn("without figures: {}", error.what());
  }
}

void ProgressKeeper::keep(const planning::PowerProgress& progress) {
  constexpr std::chrono::seconds kAtLeast{2};
  constexpr int kShare = 20;  // writing takes at most 1/20 of the time
  const Clock::time_point begun = Clock::now();
  if (begun < next_ && !planning::is_complete(progress)) return;
  replace_file(file_, planning::progress_json(progress));
  const Clock::time_point written = Clock::now();
  next_ = written + std::max<Clock::duration>(kAtLeast, kShare * (written - begun));
}

}  // namespace touchtrial::app
