/// \file Threads for the option `--jobs`. Private to protocols/simulation.
#pragma once

#include <algorithm>
#include <cstddef>
#include <thread>
#include <utility>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

namespace touchtrial::simulation {

/// Allows as many threads as asked for while it lives, even more than the processor has.
class JobArena {
 public:
  explicit JobArena(int jobs)
      : jobs_(std::min(jobs, most_jobs())),
        limit_(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(jobs_)),
        arena_(jobs_) {}

  [[nodiscard]] int jobs() const noexcept { return jobs_; }

  /// Runs `work`; parallel algorithms in it use the arena's threads.
  template <typename Work>
  void run(Work work) {
    arena_.execute(std::move(work));
  }

 private:
  /// More threads gain nothing, and the system may refuse them.
  static int most_jobs() noexcept {
    constexpr unsigned kThreadsACore = 4;
    return static_cast<int>(kThreadsACore * std::max(1U, std::thread::hardware_concurrency()));
  }

  int jobs_;
  tbb::global_control limit_;
  tbb::task_arena arena_;
};

}  // namespace touchtrial::simulation
