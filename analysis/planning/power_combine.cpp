#include "analysis/planning/power_progress.hpp"
#include "core/errors.hpp"

#include <map>

#include <fmt/format.h>

namespace touchtrial::planning {
namespace {

namespace fs = std::filesystem;
using File = std::pair<fs::path, PowerProgress>;

std::string shown(const Shard& shard) {
  return fmt::format("{}/{}", shard.number, shard.count);
}

[[noreturn]] void refuse(const fs::path& path, const std::string& what) {
  throw VerificationError(one_line(path.string() + ": " + what));
}

void require_same_run(const File& first, const File& other) {
  const auto& [path, progress] = other;
  if (progress.shard.count != first.second.shard.count) {
    refuse(path,
           fmt::format("is shard {}, but {} is shard {}; give the shards of one run alone",
                       shown(progress.shard), first.first.string(), shown(first.second.shard)));
  }
  const std::string difference = first_difference(first.second, progress);
  if (!difference.empty()) {
    refuse(path, fmt::format("{} differs from that of {}; give the shards of one run alone",
                             difference, first.first.string()));
  }
}

void require_complete(const File& file) {
  if (is_complete(file.second)) return;
  throw FileError(
      one_line(fmt::format("{}: shard {} is not complete; run it again with --resume, then combine",
                           file.first.string(), shown(file.second.shard))));
}

/// By number, each once.
std::map<int, const File*> each_once(const std::vector<File>& files,
                                     std::vector<std::string>& remarks) {
  std::map<int, const File*> by_number;
  for (const File& file : files) {
    require_same_run(files.front(), file);
    require_complete(file);
    const auto [place, is_new] = by_number.emplace(file.second.shard.number, &file);
    if (is_new) continue;
    const auto& [known_path, known] = *place->second;
    if (known.cells != file.second.cells) {
      refuse(file.first,
             fmt::format("is shard {} as {} is, but its figures differ; find out which is right "
                         "and remove the other",
                         shown(known.shard), known_path.string()));
    }
    remarks.push_back(
        one_line(fmt::format("shard {} is in {} and in {}, equal: taken once", shown(known.shard),
                             known_path.string(), file.first.string())));
  }
  return by_number;
}

/// "2, 5 and 7", and how many more if there are many.
std::string listed(const std::vector<int>& numbers) {
  constexpr std::size_t kMost = 20;
  std::string list;
  for (std::size_t i = 0; i < numbers.size() && i < kMost; ++i) {
    list += (i > 0 ? ", " : "") + std::to_string(numbers[i]);
  }
  if (numbers.size() > kMost) list += fmt::format(" and {} more", numbers.size() - kMost);
  return list;
}

void require_all(const std::map<int, const File*>& by_number, int count) {
  std::vector<int> missing;
  for (int number = 1; number <= count; ++number) {
    if (!by_number.contains(number)) missing.push_back(number);
  }
  if (missing.empty()) return;
  throw FileError(fmt::format("of {} shards {} missing: {}; run {} again, then combine", count,
                              missing.size() == 1 ? "one is" : "some are", listed(missing),
                              missing.size() == 1 ? "it" : "them"));
}

}  // namespace

CombinedPower combined(const std::vector<File>& shards) {
  if (shards.empty()) throw FileError("there is no shard to combine; give their folder or files");
  CombinedPower result;
  const auto by_number = each_once(shards, result.remarks);
  const PowerProgress& first = shards.front().second;
  const int count = first.shard.count;
  require_all(by_number, count);
  result.progress = new_progress(first.setting, first.plan, {});
  for (std::size_t c = 0; c < result.progress.cells.size(); ++c) {
    PowerCell& cell = result.progress.cells[c];
    // An only one is a whole run, which may have stopped early.
    if (first.shard.is_all()) cell.runs = first.cells[c].runs;
    for (int run = static_cast<int>(cell.runs.size()); count > 1 && run < first.plan.runs; ++run) {
      const PowerProgress& shard = by_number.at(run % count + 1)->second;
      cell.runs.push_back(shard.cells[c].runs[run / count]);
    }
    // What a single machine would not have made any more.
    cell.runs.resize(static_cast<std::size_t>(*runs_when_done(result.progress, cell)));
  }
  return result;
}

}  // namespace touchtrial::planning
