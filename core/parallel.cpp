#include "core/parallel.hpp"

#include <algorithm>
#include <exception>
#include <vector>

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace touchtrial {

void in_parallel(int jobs, std::size_t count, const std::function<void(std::size_t)>& work) {
  if (jobs == 1) {
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  const auto run_all = [&] { tbb::parallel_for(std::size_t{0}, count, work); };
  if (jobs == 0) return run_all();
  // oneTBB prints a warning if the limit exceeds the cores available to this process.
  tbb::task_arena arena(std::min(jobs, tbb::info::default_concurrency()));
  arena.execute(run_all);
}

void run_all_in_parallel(std::size_t count, const std::function<void(std::size_t)>& work) {
  std::vector<std::exception_ptr> failures(count);
  in_parallel(0, count, [&](std::size_t i) {
    try {
      work(i);
    } catch (...) {
      failures[i] = std::current_exception();
    }
  });
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

}  // namespace touchtrial
