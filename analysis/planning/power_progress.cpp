#include "analysis/planning/power_progress.hpp"

#include "analysis/planning/changes_words.hpp"
#include "core/errors.hpp"
#include "core/hash.hpp"
#include "core/parallel.hpp"
#include "core/strict_json.hpp"
#include "device/simulated/simulated_hand.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::planning {
namespace {

std::string with_spread(const char* name, double value, double spread) {
  return std::string(name) + " " + number_text(value) + " (spread " + number_text(spread) + ")";
}

/// Tells subject models apart whose words are alike.
std::string digest_of(const simulation::SubjectModel& subject) {
  constexpr std::size_t kShown = 12;
  FieldHasher hasher;
  hasher.add(simulation::subject_model_json(subject));
  hasher.add(device::device_model_json(subject.device));
  return to_hex(hasher.finish()).substr(0, kShown);
}

/// The number of runs between two calls of `keep`. Every look of a plan is a multiple of it, or the
/// plan's end.
constexpr int kBlock = 50;

void make_block(const Rehearsal& study, const PrimaryTest& test, int jobs,
                const PowerProgress& progress, PowerCell& cell) {
  const std::size_t first = cell.runs.size();
  const int own = progress.shard.own_runs(progress.plan.runs);
  const int end = std::min(own, (static_cast<int>(first) / kBlock + 1) * kBlock);
  std::vector<PowerRun> block(static_cast<std::size_t>(end) - first);
  in_parallel(jobs, block.size(), [&](std::size_t i) {
    const int run = progress.shard.run(static_cast<int>(first + i));
    const std::uint64_t seed =
        study_seed(progress.plan.seed, cell.participants, cell.hypothesis, run);
    block[i] = judged(test, study.outcomes(cell.participants, cell.hypothesis, seed),
                      cell.hypothesis == Hypothesis::null);
  });
  cell.runs.insert(cell.runs.end(), block.begin(), block.end());
}

/// Reports progress in participants, because they cost the time. A finished cell counts as whole.
void tell(const PowerProgress& progress, const PowerWork& work) {
  if (!work.progress) return;
  const int own = progress.shard.own_runs(progress.plan.runs);
  double done = 0.0;
  double all = 0.0;
  for (const PowerCell& cell : progress.cells) {
    const bool is_done = runs_when_done(progress, cell).has_value();
    const auto runs = is_done ? own : static_cast<int>(cell.runs.size());
    done += static_cast<double>(runs) * cell.participants;
    all += static_cast<double>(own) * cell.participants;
  }
  constexpr int kSteps = 1000;
  work.progress(static_cast<int>(kSteps * done / std::max(all, 1.0)), kSteps);
}

using File = std::pair<std::filesystem::path, PowerProgress>;

std::string shown(const Shard& shard) {
  return fmt::format("{}/{}", shard.number, shard.count);
}

[[noreturn]] void refuse(const File& file, const std::string& what) {
  throw VerificationError(one_line(file.first.string() + ": " + what));
}

void require_same_run(const File& first, const File& other) {
  const Shard& shard = other.second.shard;
  if (shard.count != first.second.shard.count) {
    refuse(other, fmt::format("is shard {}, but {} is shard {}; give only the shards of one run",
                              shown(shard), first.first.string(), shown(first.second.shard)));
  }
  const std::string difference = first_difference(first.second, other.second);
  if (!difference.empty()) {
    refuse(other, fmt::format("{} differs from that of {}; give only the shards of one run",
                              difference, first.first.string()));
  }
}

void require_complete(const File& file) {
  if (is_complete(file.second)) return;
  throw FileError(
      one_line(fmt::format("{}: shard {} is not complete; run it again with --resume, then combine",
                           file.first.string(), shown(file.second.shard))));
}

/// \return what to tell the user about two equal files of one shard
std::string remark_on_equal(const File& known, const File& again) {
  const std::string shard = shown(known.second.shard);
  if (known.second.cells != again.second.cells) {
    refuse(again, fmt::format("is shard {} as {} is, but its numbers differ; find out which is "
                              "right and remove the other",
                              shard, known.first.string()));
  }
  return one_line(
      fmt::format("shard {} is in {} and, with the same content, in {}: it is used once", shard,
                  known.first.string(), again.first.string()));
}

/// \param shards  by number; null: missing
void require_all(const std::vector<const File*>& shards) {
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < shards.size(); ++i) {
    if (shards[i] == nullptr) missing.push_back(i + 1);
  }
  if (missing.empty()) return;
  constexpr std::size_t kMostNamed = 20;
  const std::span named(missing.data(), std::min(missing.size(), kMostNamed));
  std::string list = fmt::format("{}", fmt::join(named, ", "));
  if (missing.size() > kMostNamed) list += fmt::format(" and {} more", missing.size() - kMostNamed);
  const bool one = missing.size() == 1;
  throw FileError(fmt::format("of {} shards {} missing: {}; run {} again, then combine",
                              shards.size(), one ? "one is" : "some are", list,
                              one ? "it" : "them"));
}

}  // namespace

std::string words_of(const simulation::SubjectModel& subject) {
  std::string words =
      device::words_of_simulated(subject.device) + ", sense " +
      std::string(simulation::name_of_sense(subject.sense)) + ", " +
      with_spread("feature_noise", subject.feature_noise, subject.feature_noise_spread) + ", " +
      with_spread("lapse", subject.lapse, subject.lapse_spread) + ", " +
      with_spread("position bias", subject.position_bias, subject.position_bias_spread) +
      ", class bias spread " + number_text(subject.class_bias_spread);
  for (const simulation::ClassBias& bias : subject.class_bias) {
    words += ", bias for " + in_quotes(bias.label) + " " + number_text(bias.log_odds);
  }
  for (const auto& [one, other] : subject.label_swap) {
    words += ", " + in_quotes(one) + " swapped with " + in_quotes(other);
  }
  if (subject.hand != device::HandKind::point_mass || subject.hand_spread != 0.0) {
    words += ", hand " + std::string(device::name_of(subject.hand)) + " (spread " +
             number_text(subject.hand_spread) + ")";
  }
  return words + ", explores " + number_text(subject.explore_s) + " s at " +
         number_text(subject.slowest_mm_s) + " to " + number_text(subject.fastest_mm_s) +
         " mm/s with " + number_text(subject.push_n) + " N, " +
         std::to_string(subject.training_passes) + " training passes" + words_of_changes(subject) +
         "; all of it " + digest_of(subject);
}

PowerProgress new_progress(PowerSetting setting, const PowerPlan& plan, const Shard& shard) {
  PowerProgress progress{std::move(setting), plan, shard, {}};
  for (const int size : plan.participants) {
    progress.cells.push_back({size, Hypothesis::population, {}});
    progress.cells.push_back({size, Hypothesis::null, {}});
  }
  return progress;
}

std::optional<int> runs_when_done(const PowerProgress& progress, const PowerCell& cell) {
  const int own = progress.shard.own_runs(progress.plan.runs);
  const bool may_stop = progress.shard.is_all() && cell.hypothesis == Hypothesis::population;
  if (may_stop) {
    if (const auto certain = certain_after(progress.plan, cell.runs)) return certain;
  }
  if (static_cast<int>(cell.runs.size()) >= own) return own;
  return std::nullopt;
}

bool is_complete(const PowerProgress& progress) {
  return std::ranges::all_of(progress.cells, [&](const PowerCell& cell) {
    return runs_when_done(progress, cell).has_value();
  });
}

std::string first_difference(const PowerProgress& a, const PowerProgress& b) {
  const PowerSetting& x = a.setting;
  const PowerSetting& y = b.setting;
  const std::pair<const char*, bool> equal[] = {
      {"the study", x.study == y.study && x.protocol == y.protocol},
      {"the study file", x.seal == y.seal},
      {"the primary test", x.test == y.test && x.estimate == y.estimate},
      {"the prepared force fields", x.fields == y.fields},
      {"the subject model", x.subject == y.subject},
      {"the program's version", x.program == y.program},
      {"--participants", a.plan.participants == b.plan.participants},
      {"--runs", a.plan.runs == b.plan.runs},
      {"--seed", a.plan.seed == b.plan.seed},
      {"--no-early-stop", a.plan.stop_early == b.plan.stop_early},
      {"--servo", a.plan.servo == b.plan.servo},
      {"--explorations", a.plan.explorations == b.plan.explorations},
      {"--trainings", a.plan.trainings == b.plan.trainings},
      {"--first-half-loss", a.plan.first_half_loss == b.plan.first_half_loss},
      {"--effect", a.plan.effect == b.plan.effect}};
  const auto differs = std::ranges::find(equal, false, &std::pair<const char*, bool>::second);
  return differs == std::end(equal) ? "" : differs->first;
}

void make_runs(const Rehearsal& study, const PrimaryTest& test, const PowerWork& work,
               PowerProgress& progress) {
  for (PowerCell& cell : progress.cells) {
    while (!runs_when_done(progress, cell)) {
      make_block(study, test, work.jobs, progress, cell);
      if (work.keep) work.keep(progress);
      tell(progress, work);
    }
  }
}

CombinedPower combined(const std::vector<File>& files) {
  if (files.empty()) throw FileError("there is no shard to combine; give their folder or files");
  const PowerProgress& first = files.front().second;
  CombinedPower result{new_progress(first.setting, first.plan, {}), {}};
  std::vector<const File*> shards(static_cast<std::size_t>(first.shard.count), nullptr);
  for (const File& file : files) {
    require_same_run(files.front(), file);
    require_complete(file);
    const File*& shard = shards[static_cast<std::size_t>(file.second.shard.number) - 1];
    if (shard != nullptr) result.remarks.push_back(remark_on_equal(*shard, file));
    if (shard == nullptr) shard = &file;
  }
  require_all(shards);
  for (std::size_t c = 0; c < result.progress.cells.size(); ++c) {
    PowerCell& cell = result.progress.cells[c];
    for (std::size_t run = 0;; ++run) {
      const std::vector<PowerRun>& own = shards[run % shards.size()]->second.cells[c].runs;
      if (run / shards.size() >= own.size()) break;
      cell.runs.push_back(own[run / shards.size()]);
    }
    // Drops the runs that a single machine would not have made.
    cell.runs.resize(static_cast<std::size_t>(*runs_when_done(result.progress, cell)));
  }
  return result;
}

}  // namespace touchtrial::planning
