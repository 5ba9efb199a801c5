#include "bench/measure/rows.hpp"

#include "bench/measure/simd_target.hpp"
#include "core/errors.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <utility>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

namespace touchtrial::bench {
namespace {

/// Keeps the medians and prints nothing.
class MedianReporter : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }

  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.aggregate_name == "median") {
        medians_us_[run.run_name.function_name] = run.GetAdjustedCPUTime();
      }
    }
  }

  [[nodiscard]] double median_us(const std::string& name) const {
    const auto found = medians_us_.find(name);
    return found == medians_us_.end() ? kNotTaken : found->second;
  }

 private:
  std::map<std::string, double> medians_us_;
};

/// Google Benchmark takes its settings from a command line.
void set_up(const Effort& effort) {
  std::vector<std::string> words = {"touchtrial-bench",
                                    "--benchmark_enable_random_interleaving=true",
                                    fmt::format("--benchmark_min_time={}", effort.repetition_s)};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
}

/// The operations of each job, which are known once it is made.
using Operations = std::map<std::string, int>;

/// Runs on images of this size take so long that a few repetitions must do.
constexpr int kLargeSize_px = 2048;
constexpr int kLeastRepetitions = 3;

int repetitions_of(const Case& one, const Effort& effort) {
  return one.is_slow || one.size_px >= kLargeSize_px
             ? std::min(kLeastRepetitions, effort.repetitions)
             : effort.repetitions;
}

void register_case(const Case& one, int repetitions, Operations& operations,
                   const std::function<void()>& begin) {
  const auto work = [&one, &operations, begin](benchmark::State& state) {
    begin();
    const ForcedTarget forced(one.target);
    const Job job = one.make();
    operations[name_of(one)] = job.operations;
    job.run();
    for ([[maybe_unused]] auto _ : state) job.run();
  };
  benchmark::RegisterBenchmark(name_of(one).c_str(), work)
      ->Repetitions(repetitions)
      ->Unit(benchmark::kMicrosecond)
      ->MeasureProcessCPUTime();
}

/// The median time of one operation of each case, in microseconds and in the cases' order. The
/// repetitions of all cases run in random order. Call it once per process.
/// \param progress  called before each repetition; `of` is an estimate that `done` never exceeds
std::vector<double> interleaved_times_us(const Cases& cases, const Effort& effort,
                                         const Progress& progress) {
  set_up(effort);
  Operations operations;
  int begun = 0;
  // Google Benchmark finds the number of runs of a repetition by two trial repetitions.
  const int expected = static_cast<int>(cases.size()) * (effort.repetitions + 2);
  const auto begin = [&] { progress(std::min(begun++, expected), expected); };
  for (const Case& one : cases) {
    register_case(one, repetitions_of(one, effort), operations, begin);
  }
  MedianReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  std::vector<double> times_us;
  for (const Case& one : cases) {
    const std::string name = name_of(one);
    times_us.push_back(reporter.median_us(name) / operations[name]);
  }
  benchmark::ClearRegisteredBenchmarks();
  return times_us;
}

}  // namespace

double error_of(const Case& one) {
  const ForcedTarget forced(one.target);
  const Job job = one.make();
  if (!job.error) return kNotTaken;
  job.run();
  const double error = job.error();
  if (!(error <= one.accuracy.tolerance)) {
    throw Error(
        fmt::format("{}: its error is {:.3g} {}, but only {:.3g} is tolerated; it "
                    "computes something else",
                    name_of(one), error, one.accuracy.unit, one.accuracy.tolerance));
  }
  return error;
}

std::vector<Row> measure_rows(const Cases& cases, const Effort& effort, const Progress& progress) {
  std::vector<Row> rows;
  const int steps = static_cast<int>(cases.size());
  for (const Case& one : cases) {
    rows.push_back({one, kNotTaken, error_of(one)});
    rows.back().what.make = nullptr;
    progress(static_cast<int>(rows.size()), 2 * steps);
  }
  const std::vector<double> times_us = interleaved_times_us(
      cases, effort, [&](int done, int of) { progress(steps + steps * done / of, 2 * steps); });
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].us = times_us[i];
  return rows;
}

}  // namespace touchtrial::bench
