/// \file What this machine can do at best: the bounds beside which the engine's times stand. They use
/// nothing of the engine, so that they do not become faster or slower with it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace touchtrial::bench {

/// How samples are written: through the caches, or past them.
enum class Writing { through_caches, past_caches };

/// Writes every byte as a float: what any extraction must read and write.
/// \pre as many bytes as samples
void stream(std::span<const std::uint8_t> bytes, std::span<float> samples, Writing how);

/// The arithmetic of the sub-bands and of two rings of an adaptive texture with an order for each
/// pixel, for this number of pixels, on numbers that stay in registers and the first few lines of
/// the first-level cache: with exact integers where the sums are integers, and with as few
/// operations as are known to do it. Leaves out gradients, square roots and orders.
/// \return depends on all results, so that none can be left out
[[nodiscard]] float texture_arithmetic(std::size_t pixels);

}  // namespace touchtrial::bench
