#include "analysis/planning/power_study.hpp"

#include <algorithm>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace touchtrial::planning {
namespace {

/// Runs between two looks at what is done; every look of a plan is a multiple, or its end.
constexpr int kBlock = 50;

class Runs {
 public:
  Runs(const RehearsedStudy& study, const PrimaryTest& test, const PowerWork& work,
       PowerProgress& progress)
      : study_(study),
        test_(test),
        work_(work),
        progress_(progress),
        threads_(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(work.jobs)),
        arena_(work.jobs) {}

  void make_all() {
    for (PowerCell& cell : progress_.cells) {
      while (!runs_when_done(progress_, cell)) {
        make_block(cell);
        if (work_.keep) work_.keep(progress_);
        tell();
      }
    }
  }

 private:
  void make_block(PowerCell& cell) {
    const std::size_t first = cell.runs.size();
    const int own = progress_.shard.own_runs(progress_.plan.runs);
    const int end = std::min(own, (static_cast<int>(first) / kBlock + 1) * kBlock);
    std::vector<PowerRun> block(static_cast<std::size_t>(end) - first);
    arena_.execute([&] {
      tbb::parallel_for(std::size_t{0}, block.size(), [&](std::size_t i) {
        block[i] = made(cell, progress_.shard.run(static_cast<int>(first + i)));
      });
    });
    cell.runs.insert(cell.runs.end(), block.begin(), block.end());
  }

  [[nodiscard]] PowerRun made(const PowerCell& cell, int run) const {
    const std::uint64_t seed =
        study_seed(progress_.plan.seed, cell.participants, cell.hypothesis, run);
    return judged(test_, study_.outcomes(cell.participants, cell.hypothesis, seed),
                  cell.hypothesis == Hypothesis::null);
  }

  /// In participants, which is what costs time; a cell that is done counts whole.
  void tell() const {
    if (!work_.progress) return;
    const int own = progress_.shard.own_runs(progress_.plan.runs);
    double done = 0.0;
    double all = 0.0;
    for (const PowerCell& cell : progress_.cells) {
      const bool is_done = runs_when_done(progress_, cell).has_value();
      const auto runs = is_done ? own : static_cast<int>(cell.runs.size());
      done += static_cast<double>(runs) * cell.participants;
      all += static_cast<double>(own) * cell.participants;
    }
    constexpr int kSteps = 1000;
    work_.progress(static_cast<int>(kSteps * done / std::max(all, 1.0)), kSteps);
  }

  const RehearsedStudy& study_;
  const PrimaryTest& test_;
  const PowerWork& work_;
  PowerProgress& progress_;
  tbb::global_control threads_;
  tbb::task_arena arena_;
};

}  // namespace

void make_runs(const RehearsedStudy& study, const PrimaryTest& test, const PowerWork& work,
               PowerProgress& progress) {
  Runs(study, test, work, progress).make_all();
}

}  // namespace touchtrial::planning
