/// \file The runs of a power analysis, on all cores. Source: docs/power.md.
#pragma once

#include "analysis/planning/power_progress.hpp"

#include <functional>

namespace touchtrial::planning {

struct PowerWork {
  int jobs = 1;  ///< threads, >= 1; results do not depend on them
  /// Called between blocks of runs, from one thread: with what is done so far.
  std::function<void(const PowerProgress&)> keep{};
  std::function<void(int done, int of)> progress{};
};

/// Makes the runs that `progress` does not have yet. What it then holds is a function of setting,
/// plan and shard, whatever it held before and however many threads there are.
/// \param study  made for the plan's largest size at least
/// \throws what `keep` throws; `progress` is then as it was kept
void make_runs(const RehearsedStudy& study, const PrimaryTest& test, const PowerWork& work,
               PowerProgress& progress);

}  // namespace touchtrial::planning
