/// \file One pair of right-or-wrong answers a participant. Source: docs/statistics.md, "Pairs";
/// Fagerland, Lydersen, Laake 2013.
#pragma once

#include <optional>

namespace touchtrial::analysis {

/// McNemar's mid-p test, two-sided, of the pairs that disagree: what is more extreme, and half of
/// what is as extreme.
/// \param first_only  pairs in which only the first is right, >= 0 \param second_only  likewise
/// \return 1 if no pair disagrees
/// \throws std::invalid_argument if a count is negative
[[nodiscard]] double mcnemar_mid_p(int first_only, int second_only);

}  // namespace touchtrial::analysis
