/// \file Threads that run one function side by side; what the stand-ins for oneTBB are made of.
#pragma once

#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace tbb::plain {

inline constexpr int kThreads = 4;

/// Runs `work` in kThreads threads, waits for all, and throws what the first to fail threw.
template <typename Work>
void in_threads(const Work& work) {
  std::mutex mutex;
  std::exception_ptr failure;
  const auto guarded = [&] {
    try {
      work();
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i) threads.emplace_back(guarded);
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace tbb::plain
