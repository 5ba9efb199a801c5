/// \file Runs work on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace touchtrial {

/// Calls work(i) for i = 0 .. count - 1, in any order. Returns when all calls have returned.
/// \param jobs  number of threads, at most the number of cores; 1: only the caller's; 0: one for
///   each core
/// \throws what a call throws; the remaining calls may then be skipped
void in_parallel(int jobs, std::size_t count, const std::function<void(std::size_t)>& work);

/// Calls work(i) on all cores, for work that can fail. Makes all calls, then throws the exception
/// of the lowest i, so the error does not depend on the number of threads.
void run_all_in_parallel(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace touchtrial
