#include "core/parallel.hpp"

#include <algorithm>
#include <thread>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace touchtrial {

void in_parallel(int jobs, std::size_t count, const std::function<void(std::size_t)>& work) {
  if (jobs == 1) {
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  const auto all = [&] { tbb::parallel_for(std::size_t{0}, count, work); };
  if (jobs == 0) return all();
  const auto cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  tbb::task_arena arena(std::min(jobs, cores));
  arena.execute(all);
}

}  // namespace touchtrial
