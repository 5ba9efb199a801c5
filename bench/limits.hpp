/// \file Lower bounds of this machine for comparison with the engine's times. They use no engine
/// code, so that they do not change with it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace touchtrial::bench {

/// How samples are written: through the caches, or past them.
enum class Writing { through_caches, past_caches };

/// Writes every byte as a float: the minimum memory traffic of an extraction.
/// \pre bytes and samples have the same size
void stream(std::span<const std::uint8_t> bytes, std::span<float> samples, Writing how);

/// The arithmetic of the sub-bands and of two rings of an adaptive texture with an order for each
/// pixel. The data stay in registers and the first lines of the L1 cache. Integer sums use exact
/// integers, with the fewest operations known. Leaves out gradients, square roots and orders.
/// \return depends on all results, so that the compiler cannot remove any
[[nodiscard]] float texture_arithmetic(std::size_t pixels);

}  // namespace touchtrial::bench
