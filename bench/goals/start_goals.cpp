// What a start of the program costs, beside the start of an empty C++ program.
#include "bench/goals/goal.hpp"
#include "bench/inputs/scratch_folder.hpp"
#include "bench/measure/median.hpp"
#include "core/errors.hpp"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace touchtrial::bench {
namespace {

namespace fs = std::filesystem;
using Command = std::vector<std::string>;

constexpr double kStartRatio = 8.0;
constexpr double kMostLibraries = 45;
constexpr double kReportRatio = 14.0;
/// Starts are short and pages of their files are shared with others: many even that out.
constexpr int kStartsPerRound = 11;

struct Start {
  double us = 0.0;      ///< processor time, the kernel's included
  double faults = 0.0;  ///< pages that had to be laid into its memory
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

/// By turns with the empty program.
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

GoalResult libraries_loaded() {
  const std::string ask = "LD_TRACE_LOADED_OBJECTS=1 '" TOUCHTRIAL_PROGRAM "'";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> list(popen(ask.c_str(), "r"), pclose);
  GoalResult result;
  result.goal = "shared libraries of a start";
  result.count = 0;
  result.count_unit = "libraries";
  result.limit = Limit::count;
  result.target = kMostLibraries;
  char line[4096];
  while (list && std::fgets(line, sizeof line, list.get()) != nullptr) {
    if (std::string(line).find("=>") != std::string::npos) ++result.count;
  }
  return result;
}

std::vector<GoalResult> measure_starts(int rounds) {
  const ScratchFolder folder;
  const std::string program = TOUCHTRIAL_PROGRAM;
  const std::string database = (folder.path() / "study.db").string();
  run_once({program, "simulate", TOUCHTRIAL_SOURCE_DIR "/config/classification.json",
            "--participants", "20", "--seed", "1", "--db", database});
  return {beside_empty("start, --version", {program, "--version"}, kStartRatio, rounds),
          libraries_loaded(),
          beside_empty("report of 20 participants", {program, "report", database}, kReportRatio,
                       rounds)};
}

}  // namespace

std::vector<Goal> start_goals() {
  return {[](const Effort& effort) { return measure_starts(effort.study_rounds); }};
}

}  // namespace touchtrial::bench
