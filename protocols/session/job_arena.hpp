/// \file Threads for the jobs that a person asked for. Private to protocols/session.
#pragma once

#include <algorithm>
#include <cstddef>
#include <thread>
#include <utility>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

namespace touchtrial::session {

/// As many threads as asked for, also beyond the processor's number, while the object lives.
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
  /// More threads than this gain nothing and may not be granted.
  static int most_jobs() noexcept {
    constexpr unsigned kThreadsACore = 4;
    return static_cast<int>(kThreadsACore * std::max(1U, std::thread::hardware_concurrency()));
  }

  int jobs_;
  tbb::global_control limit_;
  tbb::task_arena arena_;
};

}  // namespace touchtrial::session
