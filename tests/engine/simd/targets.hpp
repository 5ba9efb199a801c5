/// \file The instruction sets (targets) for which the engine's kernels are compiled. A kernel runs
/// on the best target that the processor has; tests and benchmarks may force another.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace touchtrial {

/// The names of the compiled targets that this processor can run, best first, for instance
/// {"AVX3", "AVX2", "SSE4", "SSSE3"}; AVX3 is AVX-512. Not affected by force_simd_target().
/// Thread-safe.
[[nodiscard]] std::vector<std::string> simd_targets();

/// From now on every kernel runs on this target; nullopt: on the best one again.
/// \throws std::invalid_argument if simd_targets() does not have the name
/// Affects the whole process. Do not call it while a kernel runs in another thread.
void force_simd_target(const std::optional<std::string>& name);

}  // namespace touchtrial
