/// \file The exact test of paired differences: had the two methods been the same, every
/// participant's difference could as well have had the other sign.
/// Source: docs/statistics.md, "Two methods"; Phipson, Smyth 2010.
#pragma once

#include <optional>
#include <span>

namespace touchtrial::analysis {

/// Up to this many participants all sign patterns are counted; beyond, 99,999 random ones.
inline constexpr int kExactSignFlips = 32;

/// Two-sided: the share of the sign patterns whose mean is as far from zero as the observed one.
/// Beyond kExactSignFlips it is (b + 1) / (m + 1) over m random patterns from a fixed seed.
/// \param differences  one a participant, finite
/// \return in (0, 1], never below 2 * 2^-n; nothing without differences
/// \throws std::invalid_argument if a difference is not finite
[[nodiscard]] std::optional<double> sign_flip_p(std::span<const double> differences);

/// The largest p that these differences could have had, with whatever signs, without passing the
/// level: how often the test rejects if the methods do not differ. 0 if it never can.
/// Cost: some thirty times that of sign_flip_p.
/// \throws std::invalid_argument if a difference is not finite
[[nodiscard]] double sign_flip_attainable(std::span<const double> differences, double level);

}  // namespace touchtrial::analysis
