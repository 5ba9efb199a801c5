#include "app/default_subject.hpp"
#include "bench/goals/goal.hpp"
#include "bench/inputs/scratch_folder.hpp"
#include "bench/measure/median.hpp"
#include "core/cipher.hpp"
#include "engine/pack/pack.hpp"
#include "protocols/design/prepare.hpp"
#include "protocols/session/commitment.hpp"
#include "protocols/session/simulation.hpp"
#include "protocols/session/subject_model.hpp"
#include "protocols/store/study_store.hpp"

#include <chrono>
#include <cmath>
#include <filesystem>
#include <string>

namespace touchtrial::bench {
namespace {

namespace fs = std::filesystem;

constexpr double kStudyTarget_us = 1e6;
constexpr double kTrialTarget_bytes = 100e3;
constexpr int kParticipants = 20;

struct StudyFigures {
  double us = 0.0;
  double bytes_a_trial = 0.0;
};

/// The classification study that comes with the program, 20 participants of 25 trials of 10 s, one
/// transaction a session, in one thread; by the wall clock, because the disk belongs to it.
StudyFigures simulate_once(const design::StudyKey& key, const engine::Pack& pack,
                           const fs::path& database) {
  const session::SubjectModel subject =
      session::parse_subject_model(app::default_subject_json(), "default subject");
  session::SimulationOptions options;
  options.participants = kParticipants;
  const auto start = std::chrono::steady_clock::now();
  session::SimulationReport report;
  {
    store::StudyStore store = store::StudyStore::create(
        database, session::commitment_of(key, pack, true, false), std::chrono::nanoseconds(0));
    report = session::simulate_study(key, pack, subject, options, store);
  }
  const std::chrono::duration<double, std::micro> us = std::chrono::steady_clock::now() - start;
  return {us.count(), static_cast<double>(fs::file_size(database)) / report.presentations};
}

std::vector<GoalResult> results_of(const StudyFigures& figures) {
  GoalResult time;
  time.goal = "study of 20 x 25 trials of 10 s, one thread";
  time.ours_us = figures.us;
  time.limit = Limit::time_us;
  time.target = kStudyTarget_us;
  GoalResult bytes;
  bytes.goal = "database, a trial of 10 s";
  bytes.count = std::round(figures.bytes_a_trial);
  bytes.count_unit = "bytes";
  bytes.limit = Limit::count;
  bytes.target = kTrialTarget_bytes;
  return {time, bytes};
}

std::vector<GoalResult> measure_study(int rounds) {
  const ScratchFolder folder;
  const design::Study study =
      design::load_study(fs::path(TOUCHTRIAL_SOURCE_DIR) / "config/classification.json");
  SeededEntropy entropy(study.seed);
  design::StudyKey key = design::make_study_key(study, entropy, true);
  key.pack_folder = folder.path() / "pack";
  design::prepare_pack(key, key.pack_folder, {});
  const engine::Pack pack(key.pack_folder);
  std::vector<double> times_us;
  StudyFigures figures;
  for (int round = 0; round < rounds; ++round) {
    figures = simulate_once(key, pack, folder.path() / (std::to_string(round) + ".db"));
    times_us.push_back(figures.us);
  }
  figures.us = median(times_us);
  return results_of(figures);
}

}  // namespace

std::vector<Goal> study_goals() {
  return {[](const Effort& effort) { return measure_study(effort.study_rounds); }};
}

}  // namespace touchtrial::bench
