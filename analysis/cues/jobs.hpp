/// \file Work on several threads. Private to analysis/cues: it shows oneTBB.
#pragma once

#include <cstddef>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace touchtrial {

/// Calls work(i) for i = 0 .. count - 1, in no order. \param jobs  threads; 0: as many as there are
template <typename Work>
void in_parallel(int jobs, std::size_t count, const Work& work) {
  const auto all = [&] { tbb::parallel_for(std::size_t{0}, count, work); };
  if (jobs == 0) return all();
  tbb::task_arena arena(jobs);
  arena.execute(all);
}

}  // namespace touchtrial
