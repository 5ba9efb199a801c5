#include "bench/jitter/load_threads.hpp"

namespace touchtrial::bench::jitter {

LoadThreads::LoadThreads(int count) {
  for (int i = 0; i < count; ++i) {
    threads_.emplace_back([this] {
      while (!ending_.load(std::memory_order_relaxed)) {
      }
    });
  }
}

LoadThreads::~LoadThreads() {
  ending_ = true;
  for (std::thread& thread : threads_) thread.join();
}

}  // namespace touchtrial::bench::jitter
