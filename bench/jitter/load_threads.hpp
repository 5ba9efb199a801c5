/// \file Other work on the machine, while the servo is measured.
#pragma once

#include <atomic>
#include <thread>
#include <vector>

namespace touchtrial::bench::jitter {

/// Threads of ordinary priority that use all the time they get until this is gone.
class LoadThreads {
 public:
  explicit LoadThreads(int count);
  ~LoadThreads();
  LoadThreads(const LoadThreads&) = delete;
  LoadThreads& operator=(const LoadThreads&) = delete;

 private:
  std::atomic<bool> ending_{false};
  std::vector<std::thread> threads_;
};

}  // namespace touchtrial::bench::jitter
