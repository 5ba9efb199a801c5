#include "bench/measure/google_benchmark.hpp"

#include "bench/measure/simd_target.hpp"

#include <algorithm>
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

/// The command line that Google Benchmark wants its settings in.
void set_up(const Effort& effort) {
  std::vector<std::string> words = {"touchtrial-bench",
                                    "--benchmark_enable_random_interleaving=true",
                                    fmt::format("--benchmark_min_time={}", effort.repetition_s)};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
}

/// Operations of a job, known once it was made.
using Operations = std::map<std::string, int>;

/// Images whose runs take so long that few of them do.
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

}  // namespace

std::vector<double> interleaved_times_us(const Cases& cases, const Effort& effort,
                                         const std::function<void(int done, int of)>& progress) {
  set_up(effort);
  Operations operations;
  int begun = 0;
  // The number of runs in a repetition is found by trying one, then about the right number.
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

}  // namespace touchtrial::bench
