// touchtrial-bench: run time against error, beside peers.
#include "app/console.hpp"
#include "bench/cases/cases.hpp"
#include "bench/goals/goal.hpp"
#include "bench/inputs/pictures.hpp"
#include "bench/measure/simd_target.hpp"
#include "bench/results.hpp"
#include "core/bytes.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "tests/engine/simd/targets.hpp"

#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/core/utility.hpp>
#include <tbb/global_control.h>

namespace touchtrial::bench {
namespace {

namespace fs = std::filesystem;

const fs::path kDocs = fs::path(TOUCHTRIAL_SOURCE_DIR) / "docs" / "benchmarks";

struct Arguments {
  fs::path json;
  fs::path image;
  std::string target;
  std::string only;
  int runs = 1;
  bool docs = false;
  bool quick = false;
  bool check = false;
};

Scope scope_for(const Arguments& arguments, const std::vector<std::string>& targets) {
  Scope scope;
  scope.targets = targets;
  if (arguments.quick) {
    scope.sizes_px = {kUsualSize_px};
    scope.more_sizes_px = {64};
    scope.radii = {kUsualRadius};
  }
  return scope;
}

/// Keeps the engine's work on one thread while this object lives, as its peers' is.
using OneThread = tbb::global_control;
constexpr auto kThreads = tbb::global_control::max_allowed_parallelism;

std::vector<GoalResult> take_goals(const std::vector<std::string>& targets, const Effort& effort) {
  std::vector<Goal> goals = kernel_goals(targets);
  for (Goal& goal : error_goals(targets)) goals.push_back(std::move(goal));
  const std::size_t on_one_thread = goals.size();
  for (Goal& goal : program_goals()) goals.push_back(std::move(goal));
  std::vector<GoalResult> results;
  const auto progress = app::progress_bar("goals");
  for (std::size_t i = 0; i < goals.size(); ++i) {
    std::optional<OneThread> one_thread;
    if (i < on_one_thread) one_thread.emplace(kThreads, 1);
    for (GoalResult& result : goals[i](effort)) results.push_back(std::move(result));
    progress(static_cast<int>(i + 1), static_cast<int>(goals.size()));
  }
  return results;
}

/// Runs one case without measuring it, for external profilers.
void run_only(const Arguments& arguments, const Scope& scope) {
  for (const Case& one : all_cases(scope)) {
    if (name_of(one) != arguments.only) continue;
    const ForcedTarget forced(one.target);
    const Job job = one.make();
    for (int i = 0; i < arguments.runs; ++i) job.run();
    return;
  }
  throw UsageError("--only: there is no case \"" + arguments.only +
                   "\"; give WORK/WHO/INPUT/SIZE/K=RADIUS, with the words of the rows of "
                   "docs/benchmarks/results.json");
}

/// Names what has become slower than the committed results.
/// \throws Error if there is such a goal
void check(const std::vector<GoalResult>& goals) {
  const std::string committed = text_of(ByteView(read_file(kDocs / "results.json")));
  const std::vector<std::string> slower = slower_than_committed(goals, committed);
  const std::string there = processor_of(committed);
  const std::string here = this_machine().processor;
  if (there != here) {
    app::print("note: the committed results are of another processor (" + there + ", this is " +
               here + "), on which ratios may differ by more than a tenth\n");
  }
  for (const std::string& line : slower) app::print("slower: " + line + "\n");
  if (!slower.empty()) {
    throw Error(
        fmt::format("{} of the ratios are more than a tenth above those of "
                    "docs/benchmarks/results.json",
                    slower.size()));
  }
  app::print("no ratio is more than a tenth above those of docs/benchmarks/results.json\n");
}

void run(const Arguments& arguments) {
  cv::setNumThreads(1);
  if (!arguments.image.empty()) choose_timed_picture(arguments.image);
  choose_usual_target(arguments.target);
  const std::vector<std::string> targets =
      arguments.target.empty() ? simd_targets() : std::vector{arguments.target};
  const Scope scope = scope_for(arguments, targets);
  if (!arguments.only.empty()) return run_only(arguments, scope);
  const Effort effort = arguments.quick ? quick_effort() : Effort{};
  Results results;
  results.goals = take_goals(targets, effort);
  app::print(goals_table(results.goals));
  if (arguments.check) return check(results.goals);
  if (arguments.json.empty() && !arguments.docs) return;
  const OneThread one_thread(kThreads, 1);
  results.rows = measure_rows(all_cases(scope), effort, app::progress_bar("rows"));
  if (!arguments.json.empty()) replace_file(arguments.json, results_json(this_machine(), results));
  if (arguments.docs) {
    results.courses = solver_courses(square_of(timed_picture(), kUsualSize_px));
    publish(this_machine(), results, kDocs);
  }
}

void set_up(CLI::App& program, Arguments& arguments) {
  program.add_option("--json", arguments.json,
                     "Measure every kernel at every size and write the results into this file");
  program.add_option("--image", arguments.image,
                     "Picture on which times are taken (default: bark.png)");
  program.add_option("--target", arguments.target, "Use only this SIMD target, for instance AVX2")
      ->check(CLI::IsMember(simd_targets()));
  CLI::Option* const only =
      program.add_option("--only", arguments.only, "Run only this case and measure nothing");
  program.add_option("--runs", arguments.runs, "How often to run it")
      ->check(CLI::Range(0, 1000000))
      ->needs(only)
      ->capture_default_str();
  CLI::Option* const docs = program.add_flag(
      "--docs", arguments.docs, "As --json, and update docs/benchmarks with its pictures");
  program
      .add_flag("--check", arguments.check,
                "Compare the ratios to peers and bounds with the committed results, name what is "
                "slower by more than a tenth, and fail if anything is")
      ->excludes(docs);
  program
      .add_flag("--quick", arguments.quick,
                "One size and few repetitions, to check that everything works")
      ->excludes(docs);
}

/// \return 0 done (whether goals are met or not), 1 failed, 2 bad arguments
int run_program(int argc, char** argv) {
  CLI::App program("Run time against error: the engine's kernels beside their peers");
  Arguments arguments;
  set_up(program, arguments);
  try {
    program.parse(argc, argv);
    run(arguments);
    return 0;
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "touchtrial-bench: %s\n", error.what());
    return 1;
  }
}

}  // namespace
}  // namespace touchtrial::bench

int main(int argc, char** argv) {
  return touchtrial::bench::run_program(argc, argv);
}
