#include "analysis/statistics/quantiles.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace touchtrial::analysis {

std::optional<double> quantile(std::span<const double> sorted, double share) {
  if (!(share >= 0.0 && share <= 1.0)) {
    throw std::invalid_argument("a quantile's share lies between 0 and 1");
  }
  if (sorted.empty()) return std::nullopt;
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  if (below + 1 == sorted.size()) return sorted.back();
  const double part = place - static_cast<double>(below);
  return sorted[below] + part * (sorted[below + 1] - sorted[below]);
}

Quartiles quartiles(std::vector<double> values) {
  if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); })) {
    throw std::invalid_argument("quartiles need finite values");
  }
  std::sort(values.begin(), values.end());
  return {static_cast<int>(values.size()), quantile(values, 0.25), quantile(values, 0.5),
          quantile(values, 0.75)};
}

}  // namespace touchtrial::analysis
