/// \file Median and quartiles. Source: docs/statistics.md, "Reaction times"; Hyndman, Fan 1996.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace touchtrial::analysis {

/// \param sorted  rising \param share  0 .. 1
/// \return nothing without values
/// \throws std::invalid_argument if the share is out of range
[[nodiscard]] std::optional<double> quantile(std::span<const double> sorted, double share);

struct Quartiles {
  int n = 0;
  std::optional<double> lower;
  std::optional<double> median;
  std::optional<double> upper;
};

/// \param values  in any order
/// \throws std::invalid_argument if a value is not finite
[[nodiscard]] Quartiles quartiles(std::vector<double> values);

}  // namespace touchtrial::analysis
