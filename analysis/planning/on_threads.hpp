/// \file Work on several threads. Private to analysis/planning: it shows oneTBB.
#pragma once

#include <algorithm>
#include <cstddef>
#include <thread>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace touchtrial::planning {

/// Calls work(i) for i = 0 .. count - 1, in any order.
/// \param jobs  number of threads, >= 1; no more are used than there are cores
template <typename Work>
void on_threads(int jobs, std::size_t count, const Work& work) {
  const auto cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  tbb::task_arena arena(std::min(jobs, cores));
  arena.execute([&] { tbb::parallel_for(std::size_t{0}, count, work); });
}

}  // namespace touchtrial::planning
