/// \file tbb::parallel_for over indices, in plain threads. See ../README.md.
#pragma once

#include "tbb/worker_threads.h"

#include <atomic>

namespace tbb {

template <typename Index, typename Body>
void parallel_for(Index first, Index last, const Body& body) {
  std::atomic<Index> next{first};
  plain::in_threads([&] {
    for (Index i = next++; i < last; i = next++) body(i);
  });
}

}  // namespace tbb
