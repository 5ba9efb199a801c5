/// \file Several tests at once. Source: docs/statistics.md, "Several tests"; Holm 1979.
#pragma once

#include <span>
#include <vector>

namespace touchtrial::analysis {

/// p values adjusted so that the family's error rate is held; in the order given, each 0 .. 1.
/// \throws std::invalid_argument if a p is outside 0 .. 1
[[nodiscard]] std::vector<double> holm_adjusted(std::span<const double> p_values);

}  // namespace touchtrial::analysis
