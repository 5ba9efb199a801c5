// The program as a whole: the cost of a start, and a simulated study.
#include "app/study_inputs.hpp"
#include "bench/goals/goal.hpp"
#include "bench/measure/timing.hpp"
#include "core/cipher.hpp"
#include "core/errors.hpp"
#include "core/random.hpp"
#include "device/simulated/simulated_hand.hpp"
#include "engine/pack/pack.hpp"
#include "protocols/design/prepare.hpp"
#include "protocols/registration/registration.hpp"
#include "protocols/session/commitment.hpp"
#include "protocols/session/exploration.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "protocols/simulation/felt_decision.hpp"
#include "protocols/simulation/felt_exploration.hpp"
#include "protocols/simulation/simulation.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "protocols/store/head_file.hpp"
#include "protocols/store/sealing.hpp"
#include "protocols/store/session_recorder.hpp"
#include "protocols/store/study_store.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace touchtrial::bench {
namespace {

namespace fs = std::filesystem;

/// A temporary folder, which is removed with this object.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (fs::temp_directory_path() / "touchtrial-bench-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      throw FileError(name + ": cannot be made; make room or set TMPDIR");
    }
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  [[nodiscard]] const fs::path& path() const noexcept { return path_; }

 private:
  fs::path path_;
};

using Command = std::vector<std::string>;

constexpr double kStartRatio = 8.0;
constexpr double kMostLibraries = 45;
constexpr double kReportRatio = 14.0;
/// A single start is short and shares pages of its files with other processes; many starts average
/// that out.
constexpr int kStartsPerRound = 11;

struct Start {
  double us = 0.0;      ///< processor time, including the kernel's
  double faults = 0.0;  ///< minor page faults
};

Start run_once(const Command& command) {
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t silence;
  posix_spawn_file_actions_init(&silence);
  posix_spawn_file_actions_addopen(&silence, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int refused =
      posix_spawn(&child, arguments[0], &silence, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&silence);
  int status = 0;
  rusage usage{};
  if (refused != 0 || wait4(child, &status, 0, &usage) != child || status != 0) {
    throw FileError(command[0] + ": does not run; build it with scripts/build bench");
  }
  const auto us = [](const timeval& time) {
    return 1e6 * static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec);
  };
  return {us(usage.ru_utime) + us(usage.ru_stime), static_cast<double>(usage.ru_minflt)};
}

/// Starts the command and the empty program by turns.
GoalResult beside_empty(std::string name, const Command& command, double target, int rounds) {
  std::vector<double> ours_us, peer_us, ratios, faults;
  run_once(command);
  for (int i = 0; i < rounds * kStartsPerRound; ++i) {
    const Start ours = run_once(command);
    const Start peer = run_once({TOUCHTRIAL_EMPTY_PROGRAM});
    ours_us.push_back(ours.us);
    peer_us.push_back(peer.us);
    ratios.push_back(ours.us / peer.us);
    faults.push_back(ours.faults);
  }
  GoalResult result;
  result.goal = std::move(name);
  result.peer = "empty C++ program";
  result.ours_us = median(ours_us);
  result.peer_us = median(peer_us);
  result.ratio = median(ratios);
  result.count = median(faults);
  result.count_unit = "page faults";
  result.target = target;
  return result;
}

/// The shared libraries that the dynamic linker loads for the program.
std::vector<fs::path> libraries_loaded() {
  const std::string ask = "LD_TRACE_LOADED_OBJECTS=1 '" TOUCHTRIAL_PROGRAM "'";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> list(popen(ask.c_str(), "r"), pclose);
  std::vector<fs::path> files;
  char buffer[4096];
  while (list && std::fgets(buffer, sizeof buffer, list.get()) != nullptr) {
    const std::string line = buffer;
    const std::size_t arrow = line.find("=> ");
    if (arrow != std::string::npos)
      files.emplace_back(line.substr(arrow + 3, line.rfind(" (") - arrow - 3));
  }
  return files;
}

GoalResult counted(std::string goal, double count, std::string unit, double target = kNotTaken) {
  GoalResult result;
  result.goal = std::move(goal);
  result.count = count;
  result.count_unit = std::move(unit);
  result.limit = Limit::count;
  result.target = target;
  return result;
}

double bytes_below(const fs::path& folder) {
  double bytes = 0.0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
  }
  return bytes;
}

/// The peak resident memory of a start. GNU time measures it, because what this process spawns
/// itself begins with this process's memory.
double peak_kb(const std::string& program) {
  const std::string ask = "/usr/bin/time -f %M '" + program + "' --version 2>&1 >/dev/null";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> answer(popen(ask.c_str(), "r"), pclose);
  double kb = 0.0;
  if (!answer || std::fscanf(answer.get(), "%lf", &kb) != 1) {
    throw FileError("/usr/bin/time: does not run; apt-get install time");
  }
  return kb;
}

/// The program as its package installs it.
std::vector<GoalResult> measure_installed(int rounds) {
  const ScratchFolder folder;
  run_once({TOUCHTRIAL_CMAKE, "--install", TOUCHTRIAL_BUILD_DIR, "--component", "program",
            "--strip", "--prefix", folder.path().string()});
  const std::string program = (folder.path() / "bin" / "touchtrial").string();
  double with_libraries = bytes_below(folder.path());
  const double alone = with_libraries;
  for (const fs::path& library : libraries_loaded())
    with_libraries += static_cast<double>(fs::file_size(library));
  GoalResult memory = counted("memory of a start, installed", peak_kb(program), "kB");
  memory.peer = fmt::format("empty C++ program, {:.0f} kB", peak_kb(TOUCHTRIAL_EMPTY_PROGRAM));
  return {
      beside_empty("start, installed, --version", {program, "--version"}, kStartRatio, rounds),
      memory,
      counted("installed: program, studies, pictures, manual", std::round(alone / 1e4) / 1e2, "MB"),
      counted("installed, with the libraries that it loads", std::round(with_libraries / 1e4) / 1e2,
              "MB")};
}

std::vector<GoalResult> measure_starts(int rounds) {
  const ScratchFolder folder;
  const std::string program = TOUCHTRIAL_PROGRAM;
  const std::string database = (folder.path() / "study.db").string();
  run_once({program, "simulate", TOUCHTRIAL_SOURCE_DIR "/config/classification.json",
            "--participants", "20", "--seed", "1", "--db", database});
  return {beside_empty("start, --version", {program, "--version"}, kStartRatio, rounds),
          counted("shared libraries of a start", static_cast<double>(libraries_loaded().size()),
                  "libraries", kMostLibraries),
          beside_empty("report of 20 participants", {program, "report", database}, kReportRatio,
                       rounds)};
}

constexpr double kStudyTarget_us = 1e6;
constexpr double kTrialTarget_bytes = 100e3;
constexpr double kBareTicksRatio = 2.0;
constexpr double kTwoThreadsRatio = 1.0 / 1.8;
constexpr int kParticipants = 20;

struct StudyCost {
  double us = 0.0;
  double bytes_a_trial = 0.0;
};

/// Simulates the classification study that comes with the program: 20 participants, 25 trials of
/// 10 s, one transaction for each session. The time is wall-clock time, because it includes the
/// disk.
StudyCost simulate_once(const design::StudyKey& key, const engine::Pack& pack,
                        const fs::path& database, int threads) {
  const simulation::SubjectModel subject = app::subject_for({}, key.study, {});
  simulation::SimulationOptions options;
  options.participants = kParticipants;
  options.jobs = threads;
  const auto start = std::chrono::steady_clock::now();
  simulation::SimulationReport report;
  {
    store::StudyStore store =
        store::StudyStore::create(database, session::commitment_of(key, pack, true, false),
                                  std::chrono::nanoseconds(0), key.signer());
    report = simulation::simulate_study(key, pack, subject, options, store);
  }
  const std::chrono::duration<double, std::micro> us = std::chrono::steady_clock::now() - start;
  return {us.count(), static_cast<double>(fs::file_size(database)) / report.presentations};
}

/// As many explorations as the study has trials, tick by tick: the hand and the force of a stimulus
/// and nothing else. No servo, limit, sense, trace or answer, and nobody learns before.
double bare_ticks_us(const design::StudyKey& key, const engine::Pack& pack) {
  const simulation::SubjectModel subject = app::subject_for({}, key.study, {});
  const session::StimulusSource source(pack, key);
  const simulation::SimulationOptions options;
  Vec3 kept;
  const auto start = std::chrono::steady_clock::now();
  for (int number = 1; number <= kParticipants; ++number) {
    const device::HandFactors factors =
        simulation::hand_of_participant(subject, options.seed, static_cast<std::uint64_t>(number));
    for (int trial = 1; trial <= key.study.scored_trials(); ++trial) {
      RandomStream random = simulation::stream_of_trial(
          options.seed, simulation::kExplorationPurpose, number, static_cast<std::uint64_t>(trial));
      device::SimulatedHand hand =
          simulation::make_exploring_hand(subject, source.plane(), random, factors);
      const auto stimulus = static_cast<std::size_t>(trial) % key.stimuli.size();
      session::ModelForce force(source.model(key.stimuli[stimulus].code));
      device::DeviceSample sample;
      while (hand.read(sample) == device::DeviceStatus::ok) {
        static_cast<void>(hand.write(force.force_n(sample)));
      }
      kept = kept + sample.position_mm;
    }
  }
  benchmark::DoNotOptimize(kept);
  const std::chrono::duration<double, std::micro> us = std::chrono::steady_clock::now() - start;
  return us.count();
}

/// The median times of the rounds.
struct StudyTimes {
  double one_thread_us = 0.0;
  double two_threads_us = 0.0;
  double bare_ticks_us = 0.0;
  double bytes_a_trial = 0.0;
};

GoalResult compared(std::string goal, double ours_us, std::string peer, double peer_us,
                    double target) {
  GoalResult result;
  result.goal = std::move(goal);
  result.peer = std::move(peer);
  result.ours_us = ours_us;
  result.peer_us = peer_us;
  result.ratio = ours_us / peer_us;
  result.target = target;
  return result;
}

std::vector<GoalResult> results_of(const StudyTimes& times) {
  GoalResult time;
  time.goal = "study of 20 x 25 trials of 10 s, one thread";
  time.ours_us = times.one_thread_us;
  time.limit = Limit::time_us;
  time.target = kStudyTarget_us;
  return {time,
          compared("the same study against its 5 million ticks", times.one_thread_us,
                   "hand and force alone", times.bare_ticks_us, kBareTicksRatio),
          compared("the same study, two threads", times.two_threads_us, "one thread",
                   times.one_thread_us, kTwoThreadsRatio),
          counted("database, a trial of 10 s", std::round(times.bytes_a_trial), "bytes",
                  kTrialTarget_bytes)};
}

std::vector<GoalResult> measure_study(int rounds) {
  const ScratchFolder folder;
  registration::register_protocols();
  const design::Study study =
      design::load_study(fs::path(TOUCHTRIAL_SOURCE_DIR) / "config/classification.json");
  SeededEntropy entropy(study.seed);
  design::StudyKey key = design::make_study_key(study, entropy, true);
  key.pack_folder = folder.path() / "pack";
  design::prepare_pack(key, key.pack_folder, {});
  const engine::Pack pack(key.pack_folder);
  std::vector<double> one_us, two_us, bare_us;
  StudyTimes times;
  for (int round = 0; round < rounds; ++round) {
    const auto place = [&](const char* name) {
      return folder.path() / (std::to_string(round) + name + ".db");
    };
    const StudyCost cost = simulate_once(key, pack, place("one"), 1);
    times.bytes_a_trial = cost.bytes_a_trial;
    one_us.push_back(cost.us);
    bare_us.push_back(bare_ticks_us(key, pack));
    two_us.push_back(simulate_once(key, pack, place("two"), 2).us);
  }
  times.one_thread_us = median(one_us);
  times.two_threads_us = median(two_us);
  times.bare_ticks_us = median(bare_us);
  return results_of(times);
}

constexpr int kTraceSamples = 10'000;

/// A trace of 10 s at 1 kHz, as long as the longest exploration of the default study.
store::Trace long_trace() {
  RandomStream draws(1, "benchmark trace");
  store::Trace trace;
  trace.rate_hz = 1000.0;
  for (int i = 0; i < kTraceSamples; ++i) {
    const double t_s = 1e-3 * i;
    trace.samples.push_back({{40.0 + 30.0 * std::sin(3.0 * t_s), 50.0, -1.0},
                             {0.05 * draws.normal(), 0.05 * draws.normal(), 0.7}});
  }
  return trace;
}

/// The median time until one answer with its trace is durable, and so may be acknowledged.
/// \param with_head  whether a head file is synced too
double acknowledgement_us(const design::StudyKey& key, const engine::Pack& pack,
                          const fs::path& database, bool with_head) {
  const Signer signer = key.signer();
  store::StudyStore store =
      store::StudyStore::create(database, session::commitment_of(key, pack, true, false),
                                std::chrono::nanoseconds(0), signer);
  if (with_head) {
    const store::HeadFiles heads(database, {signer.public_half()});
    store.keep_heads([=](const store::HeadChange& change) { heads.update(signer, change); });
  }
  const SecretKey participant{};
  const auto sink =
      store.begin_session(1, store::wrap_participant_key(key.investigator_box, 1, participant));
  store::SessionRecorder recorder(1, participant, *sink);
  store::SessionOpening opening;
  opening.participant = "P1";
  opening.enrolment = 1;
  opening.study_id = key.study_id;
  opening.seal = key.seal;
  opening.simulated = true;
  recorder.opened({}, opening, "{}");
  const store::Trace trace = long_trace();
  std::vector<double> times_us;
  for (int trial = 1; trial <= key.study.scored_trials(); ++trial) {
    const auto at = std::chrono::seconds(trial);
    recorder.presented(at, trial, 0);
    store::TraceBody body;
    body.trial = trial;
    body.rate_hz = trace.rate_hz;
    const store::TrialEvidence evidence = recorder.packed(body, {}, trace);
    const auto start = std::chrono::steady_clock::now();
    recorder.answered(at, {.trial = trial, .position = 0, .first_position = {}, .confidence = {}},
                      evidence);
    const std::chrono::duration<double, std::micro> us = std::chrono::steady_clock::now() - start;
    times_us.push_back(us.count());
  }
  return median(times_us);
}

std::vector<GoalResult> measure_acknowledgement(int rounds) {
  const ScratchFolder folder;
  registration::register_protocols();
  const design::Study study =
      design::load_study(fs::path(TOUCHTRIAL_SOURCE_DIR) / "config/classification.json");
  design::StudyKey key = design::simulated_study_key(study);
  key.pack_folder = folder.path() / "pack";
  design::prepare_pack(key, key.pack_folder, {});
  const engine::Pack pack(key.pack_folder);
  std::vector<double> with_us;
  std::vector<double> without_us;
  for (int round = 0; round < rounds; ++round) {
    const auto place = [&](const char* name) {
      return folder.path() / (std::to_string(round) + name + ".db");
    };
    with_us.push_back(acknowledgement_us(key, pack, place("with"), true));
    without_us.push_back(acknowledgement_us(key, pack, place("without"), false));
  }
  GoalResult result;
  result.goal = "an answer with its trace of 10 s until it is acknowledged";
  result.peer = "without a head file";
  result.ours_us = median(with_us);
  result.peer_us = median(without_us);
  result.ratio = result.ours_us / result.peer_us;
  return {result};
}

}  // namespace

std::vector<Goal> program_goals() {
  return {[](const Effort& effort) { return measure_acknowledgement(effort.study_rounds); },
          [](const Effort& effort) { return measure_study(effort.study_rounds); },
          [](const Effort& effort) { return measure_starts(effort.study_rounds); },
          [](const Effort& effort) { return measure_installed(effort.study_rounds); }};
}

}  // namespace touchtrial::bench
