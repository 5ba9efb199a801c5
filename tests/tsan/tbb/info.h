/// \file tbb::info for the threads that stand in for oneTBB's. See ../README.md.
#pragma once

#include "tbb/worker_threads.h"

namespace tbb::info {

inline int default_concurrency() {
  return plain::kThreads;
}

}  // namespace tbb::info
