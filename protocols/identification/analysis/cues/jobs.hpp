/// \file Runs work on several threads. Private to protocols/identification/analysis/cues, because
/// it exposes oneTBB.
#pragma once

#include <algorithm>
#include <cstddef>
#include <thread>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace touchtrial::analysis::identification {

/// Calls work(i) for i = 0 .. count - 1, in no particular order.
/// \param jobs  threads, at most one for each core; 0: one for each core
template <typename Work>
void in_parallel(int jobs, std::size_t count, const Work& work) {
  const auto all = [&] { tbb::parallel_for(std::size_t{0}, count, work); };
  if (jobs == 0) return all();
  const auto cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  tbb::task_arena arena(std::min(jobs, cores));
  arena.execute(all);
}

}  // namespace touchtrial::analysis::identification
