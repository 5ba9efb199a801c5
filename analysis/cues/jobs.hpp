/// \file Work on several threads. Private to analysis/cues: it shows oneTBB.
#pragma once

#include <algorithm>
#include <cstddef>
#include <thread>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace touchtrial::analysis {

/// Calls work(i) for i = 0 .. count - 1, in no order.
/// \param jobs  threads, no more than there are cores; 0: as many as there are
template <typename Work>
void in_parallel(int jobs, std::size_t count, const Work& work) {
  const auto all = [&] { tbb::parallel_for(std::size_t{0}, count, work); };
  if (jobs == 0) return all();
  const auto cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  tbb::task_arena arena(std::min(jobs, cores));
  arena.execute(all);
}

}  // namespace touchtrial::analysis
