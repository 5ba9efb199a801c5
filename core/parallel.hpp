/// \file Work on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace touchtrial {

/// Calls work(i) for i = 0 .. count - 1, in any order. Returns when all calls have returned.
/// \param jobs  number of threads, at most the number of cores; 1: only the caller's; 0: one for
///   each core
/// \throws what a call throws; the remaining calls may then be skipped
void in_parallel(int jobs, std::size_t count, const std::function<void(std::size_t)>& work);

/// The same on all cores, for work that can fail: all calls are made, and the exception of the
/// lowest i is thrown, for any number of threads.
void all_in_parallel(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace touchtrial
