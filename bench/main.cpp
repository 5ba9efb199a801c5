// touchtrial-bench: the cases of the benchmark table, as benchmarks of Google Benchmark.
// scripts/bench runs it row by row and compares the times.
#include "bench/inputs.hpp"
#include "bench/rows.hpp"
#include "core/errors.hpp"
#include "tests/engine/simd/targets.hpp"

#include <cstddef>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <benchmark/benchmark.h>
#include <opencv2/core/utility.hpp>
#include <opencv2/core/version.hpp>
#include <tbb/global_control.h>

namespace touchtrial::bench {
namespace {

constexpr auto kThreads = tbb::global_control::max_allowed_parallelism;
constexpr int kRepetitions = 21;
constexpr int kSlowRepetitions = 5;

struct Arguments {
  std::string name;
  std::filesystem::path image;
  std::string target;
  int runs = 0;
  bool quick = false;
};

/// A case whose job is created when it is first run.
class LazyCase {
 public:
  /// \param goal  of the case's row; none for peers and bounds
  LazyCase(Case benchmark_case, const Row& row, const Goal& goal)
      : case_(std::move(benchmark_case)),
        goal_(goal),
        goal_name_("goal: " + std::string(goal.metric)),
        error_name_("error: " + row.error_unit),
        count_name_("count: " + row.count_unit) {}

  void measure(benchmark::State& state) {
    const tbb::global_control threads(kThreads, static_cast<std::size_t>(case_.threads));
    run(1);  // warms the caches
    if (job_->error && !error_) error_ = job_->error();
    if (error_.value_or(0.0) > case_.tolerance) {
      return state.SkipWithError(
          "its error exceeds the tolerance, so it does not compute the same result");
    }
    while (state.KeepRunningBatch(case_.operations)) {
      if (job_->run) job_->run();
    }
    if (error_) state.counters[error_name_] = *error_;
    if (job_->count) state.counters[count_name_] = job_->count();
    if (!goal_.metric.empty()) state.counters[goal_name_] = goal_.target;
  }

  void run(int runs) {
    force_simd_target(case_.simd_target);
    if (!job_) job_ = case_.make();
    for (int i = 0; job_->run && i < runs; ++i) job_->run();
  }

 private:
  Case case_;
  Goal goal_;
  std::string goal_name_, error_name_, count_name_;
  std::optional<Job> job_;
  std::optional<double> error_;
};

void register_case(const std::string& name, Case benchmark_case, const Row& row, const Goal& goal,
                   const Arguments& arguments) {
  if (benchmark_case.simd_target.empty()) benchmark_case.simd_target = arguments.target;
  const auto lazy_case = std::make_shared<LazyCase>(benchmark_case, row, goal);
  if (arguments.runs > 0) return lazy_case->run(arguments.runs);
  auto* const registered = benchmark::RegisterBenchmark(
      name.c_str(), [=](benchmark::State& state) { lazy_case->measure(state); });
  registered->Unit(benchmark::kMicrosecond);
  if (benchmark_case.clock == Clock::wall) registered->UseRealTime();
  if (benchmark_case.clock == Clock::processor) registered->MeasureProcessCPUTime();
  if (benchmark_case.clock == Clock::none) registered->Iterations(1);
  const bool runs_once = arguments.quick || benchmark_case.clock == Clock::none;
  registered->Repetitions(runs_once ? 1 : benchmark_case.is_slow ? kSlowRepetitions : kRepetitions);
}

/// \return whether a row or a case has the name in `arguments`
bool register_rows(const Rows& rows, const Arguments& arguments) {
  bool found = false;
  for (const Row& row : rows) {
    const auto add = [&](const std::string& case_name, const Case& benchmark_case,
                         const Goal& goal) {
      const std::string name = row.title + " | " + case_name;
      if (!arguments.name.empty() && arguments.name != row.title && arguments.name != name) return;
      found = true;
      register_case(name, benchmark_case, row, goal, arguments);
    };
    add(row.ours.name, row.ours, row.goal);
    for (const Case& peer : row.peers) add(peer.name, peer, {});
    for (const Case& bound : row.bounds) add("bound: " + bound.name, bound, {});
  }
  return found;
}

void run(Arguments arguments) {
  cv::setNumThreads(1);
  if (!arguments.image.empty()) choose_timed_picture(arguments.image);
  const Scope scope{arguments.target.empty() ? simd_targets() : std::vector{arguments.target},
                    arguments.quick};
  arguments.target = scope.simd_targets.front();
  benchmark::AddCustomContext("compiler", TOUCHTRIAL_COMPILER);
  benchmark::AddCustomContext("opencv", CV_VERSION);
  benchmark::AddCustomContext("instruction_set", instruction_set_of(scope.simd_targets.front()));
  bool found = false;
  for (const Rows& rows :
       {extraction_rows(scope), metric_rows(scope), servo_rows(), study_rows()}) {
    found = register_rows(rows, arguments) || found;
  }
  if (!found) {
    throw UsageError(arguments.name +
                     ": is neither a row nor a case; --benchmark_list_tests=true lists them");
  }
  if (arguments.runs == 0) benchmark::RunSpecifiedBenchmarks();
}

/// \return the exit code: 0 done, 1 failed, 2 invalid arguments
int run_program(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  CLI::App program("The table's cases as benchmarks; also accepts the options of Google Benchmark");
  Arguments arguments;
  program.add_option("NAME", arguments.name, "Only this row, or this case: \"ROW | CASE\"");
  program.add_option("--image", arguments.image, "Measure with this picture instead of bark.png");
  program.add_option("--target", arguments.target, "Use only this SIMD target, for instance AVX2")
      ->check(CLI::IsMember(simd_targets()));
  program.add_option("--runs", arguments.runs, "Run the case this many times without measuring");
  program.add_flag("--quick", arguments.quick, "One repetition, with few pictures");
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
