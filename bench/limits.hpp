/// \file Lower bounds of the engine's times on this machine, measured without the engine's code.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace touchtrial::bench {

/// Whether written samples pass through the caches.
enum class WriteMode { through_caches, past_caches };

/// Writes every byte as a float: the minimum memory traffic of an extraction.
/// \pre bytes and samples have the same size
void stream(std::span<const std::uint8_t> bytes, std::span<float> samples, WriteMode mode);

/// Runs the arithmetic of the sub-bands and of two rings of an adaptive texture with an order per
/// pixel, but computes no gradients, square roots or orders. The data stay in registers and the L1
/// cache. Integer sums are exact, with the fewest known operations.
/// \return a number that depends on all results, so that the compiler cannot remove any
[[nodiscard]] float texture_arithmetic(std::size_t pixels);

}  // namespace touchtrial::bench
