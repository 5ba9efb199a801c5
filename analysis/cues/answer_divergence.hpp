/// \file How differently two observers answer. Source: docs/cues.md; Lin 1991, IEEE Transactions on
/// Information Theory 37(1).
#pragma once

#include <optional>
#include <span>

namespace touchtrial::analysis {

/// Jensen and Shannon's divergence of two distributions, given as counts: half the sum of what each
/// tells beyond their middle.
/// \param a,b  as many counts, >= 0, the sum of each > 0
/// \return bits, 0 if the shares are equal, 1 if they have nothing in common
[[nodiscard]] double jensen_shannon_bits(std::span<const double> a,
                                         std::span<const double> b) noexcept;

/// The mean over presented classes of the divergence between two observers' answers to them;
/// classes that either was never presented with do not count. \param a,b  counts, classes x
/// classes, rows are the presented class \return nothing if no class counts
[[nodiscard]] std::optional<double> answer_divergence(std::span<const double> a,
                                                      std::span<const double> b,
                                                      int classes) noexcept;

}  // namespace touchtrial::analysis
